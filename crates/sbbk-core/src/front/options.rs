/// Which front: the paper's, or the one that pays.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum FrontOptions {
    /// The front of the paper: lowered only, every pair tested at each query, deepest first. It is
    /// as large as all that ever met.
    Paper,
    /// Raised as well as lowered, no pair tested while motion cannot have changed it, and a fresh
    /// descent where that is cheaper.
    #[default]
    Adaptive,
}
