//! A union-find.

mod compact_indices;
mod union_find;

pub(crate) use compact_indices::CompactIndices;
pub use union_find::UnionFind;
