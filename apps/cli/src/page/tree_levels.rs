//! The levels of a tree, for pictures.

use p2m_bvh::{PacketTree, TreeNode, Volume};

/// The nodes of a tree, level by level.
pub(crate) struct TreeLevels<'t, V: Volume> {
    tree: &'t PacketTree<V>,
    nodes: Vec<TreeNode<V>>,
}

impl<'t, V: Volume> TreeLevels<'t, V> {
    pub(crate) fn new(tree: &'t PacketTree<V>) -> Self {
        Self { tree, nodes: tree.parts().collect() }
    }

    /// Returns the number of levels.
    pub(crate) fn count(&self) -> usize {
        self.nodes.iter().map(|node| node.depth + 1).max().unwrap_or(0)
    }

    /// Returns the nodes of a level and the leaves above it, which together hold the whole scene.
    pub(crate) fn level(&self, level: usize) -> Vec<&TreeNode<V>> {
        let is_shown = |node: &&TreeNode<V>| node.depth == level || (node.depth < level && self.is_leaf(node));
        self.nodes.iter().filter(is_shown).collect()
    }

    /// Returns the leaves.
    pub(crate) fn leaves(&self) -> Vec<&TreeNode<V>> {
        self.nodes.iter().filter(|node| self.is_leaf(node)).collect()
    }

    fn is_leaf(&self, node: &TreeNode<V>) -> bool {
        self.tree.primitives(node).is_some()
    }
}
