/// Which parts of a front are used: all of them by default. Each can be left out, to measure it alone.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct FrontOptions {
    /// A pair of nodes whose volumes have parted stands for everything below it again. Without it, as in the paper, a front only
    /// goes down, and is as large as all that ever met.
    pub raise: bool,
    /// A pair is tested first on the axis that separated it last.
    pub cached_axis: bool,
    /// A pair is not tested while motion cannot have changed it.
    pub motion_bound: bool,
    /// Where a fresh descent is cheaper, as in fast motion, there is one, and no front is kept. What is
    /// cheaper is known from the motion bound; without it, that is always a fresh descent.
    pub adaptive: bool,
    /// Which of the pairs to be tested come first.
    pub order: FrontOrder,
}

/// In which order the pairs of a front are tested.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum FrontOrder {
    /// As in the paper.
    DeepestFirst,
    /// A pair that parts takes everything below it with it, and that need not be tested any more.
    #[default]
    HighestFirst,
}

impl FrontOptions {
    /// The front of the paper: lowered only, every pair tested at each query, deepest first.
    pub const PAPER: Self = Self {
        raise: false,
        cached_axis: false,
        motion_bound: false,
        adaptive: false,
        order: FrontOrder::DeepestFirst,
    };

    /// What was fastest in the measurements. Cached axes are left out: see [`front`](super).
    pub const ADAPTIVE: Self = Self {
        raise: true,
        cached_axis: false,
        motion_bound: true,
        adaptive: true,
        order: FrontOrder::HighestFirst,
    };
}

impl Default for FrontOptions {
    fn default() -> Self {
        Self::ADAPTIVE
    }
}
