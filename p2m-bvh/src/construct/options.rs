//! Options of splits.

/// The rule by which a node is split in two.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum SplitRule {
    /// The surface-area heuristic with 16 bins along each axis \[Wald2007\]. It minimises n_left A_left + n_right
    /// A_right, where n is a number of primitives and A a surface area. This is the expected cost of a random line.
    #[default]
    Sah,
    /// The surface-area heuristic along the longest side of the node alone, as in \[Cavarga2021\]. The cost is first
    /// sampled coarsely and then twice more finely around the best position. Unlike in the article, a primitive goes to
    /// one side only, by its centre.
    AdaptiveSah,
    /// A split at the median, along the axis on which the centres spread most.
    Median,
}

impl SplitRule {
    /// All rules, the default one first.
    pub const ALL: [Self; 3] = [Self::Sah, Self::AdaptiveSah, Self::Median];
}

/// Options of splitting a set. Most programs need only `rule` and `parallel`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SplitOptions {
    /// The largest number of primitives in a leaf. Smaller nodes are split as well if that makes queries cheaper.
    pub max_leaf: usize,
    /// The number of primitives that are tested at once. A leaf costs as much as the blocks of this size that it needs.
    pub block: usize,
    /// The cost of visiting an inner node, in units of the cost of testing a primitive.
    pub node_cost: f64,
    /// The rule by which nodes are split.
    pub rule: SplitRule,
    /// Whether the build uses all threads of the current pool, which needs the feature `rayon`. The tree is the same
    /// for any number of threads.
    pub parallel: bool,
}

impl Default for SplitOptions {
    /// Returns the options for leaves that are packets of sixteen.
    fn default() -> Self {
        Self { max_leaf: 16, block: 16, node_cost: 16.0, rule: SplitRule::Sah, parallel: true }
    }
}

impl SplitOptions {
    /// Sets the rule by which nodes are split.
    #[must_use]
    pub fn with_rule(self, rule: SplitRule) -> Self {
        Self { rule, ..self }
    }
    /// Sets whether the build uses all threads.
    #[must_use]
    pub fn with_parallel(self, parallel: bool) -> Self {
        Self { parallel, ..self }
    }
}

/// The options of a tree whose volumes share data.
pub trait TreeOptions<Shared> {
    /// Returns the options of the splits.
    fn splits(&self) -> &SplitOptions;
    /// Returns the data that all volumes of the tree share.
    fn shared(&self) -> Shared;
}

impl TreeOptions<()> for SplitOptions {
    fn splits(&self) -> &SplitOptions {
        self
    }
    fn shared(&self) {}
}
