//! A scene in the form of the card: nodes of four children over plates, and the exact vertices.

use crate::CudaError;
use crate::raw::{NO_VERTEX, Node, Plate, Primitive};
use bytemuck::Pod;
use nalgebra::Point3;
use p2m_bvh::{AabbTree, PacketTree, TreeNode};
use p2m_core::engine::local_frame::LocalFrame;
use p2m_core::engine::vector::V3;
use p2m_core::{Aabb, Primitive as _, PrimitiveId, PrimitiveSet, Real};
use rustc_hash::FxHashMap;

/// The depth from which a subtree is divided by the order of its packets alone, which bounds the stacks of the kernels
/// (`MAX_DEPTH` in `tree.cuh`). A node of eight children takes two levels, then 14 levels divide 2^28 packets, and one
/// more has the parts of a packet.
const MAX_SPLIT_DEPTH: usize = 12;
/// The largest depth of a tree (`tree.cuh`).
const MAX_DEPTH: usize = 40;
/// The number of plates of a leaf.
const LEAF_PLATES: usize = 4;

/// A scene in the layout of the card.
pub(crate) struct Scene<T> {
    pub(crate) nodes: Vec<Node>,
    pub(crate) plates: Vec<Plate>,
    pub(crate) primitives: Vec<Primitive>,
    pub(crate) vertices: Vec<[T; 3]>,
    pub(crate) centre: V3,
    pub(crate) per_unit: f64,
    /// Half of the box of the scene in its frame, whose origin is the centre of the box.
    pub(crate) half_extent: V3,
}

/// A child of a node: its box in the frame, and its node or plates.
#[derive(Clone, Copy)]
struct Child {
    bounds: [[f32; 3]; 2],
    first: u32,
    count: u32,
}

impl<T: Real + Pod> Scene<T> {
    /// Converts a tree with its set.
    pub(crate) fn new<S: PrimitiveSet<T>>(index: &AabbTree<T, S>) -> Result<Self, CudaError> {
        let tree = index.tree();
        let Some(root) = tree.root() else { return Err(CudaError::Empty) };
        if !tree.frame.is_plain() {
            return Err(CudaError::Scale);
        }
        let place = |corner: &Point3<f64>| tree.frame.place(&[corner.x, corner.y, corner.z]);
        let [low, high] = [&tree.bounds().min, &tree.bounds().max].map(place);
        let mut builder = Builder {
            set: index.set(),
            tree,
            numbers: FxHashMap::default(),
            scene: Self {
                nodes: Vec::new(),
                plates: Vec::new(),
                primitives: Vec::new(),
                vertices: Vec::new(),
                centre: tree.frame.centre,
                per_unit: tree.frame.per_unit,
                half_extent: std::array::from_fn(|k| high[k].max(-low[k])),
            },
        };
        let child = builder.child(&root, 0)?;
        // The root is a node.
        if child.count > 0 {
            builder.node(&[child]);
        }
        let depth = builder.scene.depth();
        if depth > MAX_DEPTH { Err(CudaError::TooDeep { depth }) } else { Ok(builder.scene) }
    }

    /// Returns the number of nodes on the longest path from the root.
    fn depth(&self) -> usize {
        let (mut longest, mut pending) = (0, vec![(0u32, 1)]);
        while let Some((number, depth)) = pending.pop() {
            longest = longest.max(depth);
            let node = &self.nodes[number as usize];
            let is_node = |slot: &usize| node.count[*slot] == 0 && node.bounds[0][0][*slot] <= node.bounds[0][1][*slot];
            pending.extend((0..4).filter(is_node).map(|slot| (node.first[slot], depth + 1)));
        }
        longest
    }
}

struct Builder<'a, T: Real, S> {
    set: &'a S,
    tree: &'a PacketTree<Aabb<f64>>,
    /// The number of each vertex by the bits of its coordinates, so that equal vertices are stored once.
    numbers: FxHashMap<[u64; 3], u32>,
    scene: Scene<T>,
}

impl<T: Real + Pod, S: PrimitiveSet<T>> Builder<'_, T, S> {
    /// Converts a node or a packet of the tree, which is `depth` levels below the root.
    fn child(&mut self, node: &TreeNode<Aabb<f64>>, depth: usize) -> Result<Child, CudaError> {
        // A packet may be continued by packets of equal primitives with higher ids. They are left out, because they are
        // never the answer.
        if let Some(ids) = self.tree.primitives(node) {
            let runs: Result<Vec<Child>, CudaError> = ids.chunks(LEAF_PLATES).map(|ids| self.run(ids)).collect();
            return Ok(self.joined(&runs?));
        }
        // A node comes before its children, so the root is node 0.
        let number = self.reserve();
        let children = if depth < MAX_SPLIT_DEPTH {
            let children: Vec<_> = self.tree.children(node).collect();
            children.iter().map(|child| self.child(child, depth + 1)).collect::<Result<Vec<_>, _>>()?
        } else {
            let mut packets = Vec::new();
            let mut pending = vec![*node];
            while let Some(node) = pending.pop() {
                match self.tree.primitives(&node) {
                    Some(_) => packets.push(node),
                    None => pending.extend(self.tree.children(&node)),
                }
            }
            packets.iter().map(|packet| self.child(packet, depth)).collect::<Result<Vec<_>, _>>()?
        };
        Ok(self.fill(number, &children))
    }

    fn reserve(&mut self) -> u32 {
        self.scene.nodes.push(bytemuck::Zeroable::zeroed());
        u32::try_from(self.scene.nodes.len() - 1).expect("fewer nodes than primitives")
    }

    /// Returns the only child, or a new node with all children.
    fn joined(&mut self, children: &[Child]) -> Child {
        match children {
            &[child] => child,
            _ => self.node(children),
        }
    }

    fn node(&mut self, children: &[Child]) -> Child {
        let number = self.reserve();
        self.fill(number, children)
    }

    /// Sets the children of a node. More than four children are divided into four groups, each of which becomes a
    /// child.
    fn fill(&mut self, number: u32, children: &[Child]) -> Child {
        let quarter = children.len().div_ceil(4);
        let children: Vec<Child> = children.chunks(quarter).map(|children| self.joined(children)).collect();
        let mut node = Node { bounds: [[[f32::INFINITY; 4], [f32::NEG_INFINITY; 4]]; 3], first: [0; 4], count: [0; 4] };
        let mut all = children[0].bounds;
        for (slot, child) in children.iter().enumerate() {
            for (axis, bounds) in node.bounds.iter_mut().enumerate() {
                bounds[0][slot] = child.bounds[0][axis];
                bounds[1][slot] = child.bounds[1][axis];
            }
            all[0] = std::array::from_fn(|axis| all[0][axis].min(child.bounds[0][axis]));
            all[1] = std::array::from_fn(|axis| all[1][axis].max(child.bounds[1][axis]));
            (node.first[slot], node.count[slot]) = (child.first, child.count);
        }
        self.scene.nodes[number as usize] = node;
        Child { bounds: all, first: number, count: 0 }
    }

    /// Adds the primitives of a leaf.
    fn run(&mut self, ids: &[PrimitiveId]) -> Result<Child, CudaError> {
        let first = self.scene.plates.len();
        let mut bounds = Aabb::empty();
        for &id in ids {
            let primitive = self.set.get(id);
            let corners = primitive.vertices();
            if corners.is_empty() {
                return Err(CudaError::NoVertices { id });
            }
            let mut vertex = [NO_VERTEX; 3];
            let mut local = [[0.0; 3]; 3];
            for (k, corner) in corners.iter().enumerate() {
                let point = Point3::from(corner.coords.map(Real::to_f64));
                bounds = bounds.union(&Aabb::from_points(&[point]));
                local[k] = self.tree.frame.place(&[point.x, point.y, point.z]);
                vertex[k] = self.vertex(corner)?;
            }
            self.scene.plates.push(plate(&local[..corners.len()]));
            self.scene.primitives.push(Primitive { vertex, id: id.number() });
        }
        let first = u32::try_from(first).map_err(|_| CudaError::TooMany { count: first })?;
        let count = u32::try_from(ids.len()).expect("a packet has sixteen primitives");
        Ok(Child { bounds: self.tree.frame.enclose(&bounds), first, count })
    }

    fn vertex(&mut self, corner: &Point3<T>) -> Result<u32, CudaError> {
        let vertices = &mut self.scene.vertices;
        let bits = [corner.x, corner.y, corner.z].map(|x| x.to_f64().to_bits());
        let count = vertices.len();
        let next = u32::try_from(count).ok().filter(|&n| n != NO_VERTEX).ok_or(CudaError::TooMany { count })?;
        Ok(*self.numbers.entry(bits).or_insert_with(|| {
            vertices.push([corner.x, corner.y, corner.z]);
            next
        }))
    }
}

/// Returns the plate of a point, a segment or a triangle with these vertices in the frame of the scene.
#[allow(clippy::cast_possible_truncation, reason = "rounded, by what the proof allows for")]
pub(crate) fn plate(vertices: &[V3]) -> Plate {
    let LocalFrame { origin, axes: [along, up, _], length, apex: [x, y] } = LocalFrame::new(vertices);
    let direction = |x: f64, y: f64| {
        let end = x.hypot(y);
        if end > 0.0 { [(x / end) as f32, (y / end) as f32, end as f32] } else { [1.0, 0.0, 0.0] }
    };
    Plate {
        origin: origin.map(|x| x as f32),
        along: along.map(|x| x as f32),
        up: up.map(|x| x as f32),
        length: length as f32,
        left: direction(x, y),
        right: direction(x - length, y),
    }
}
