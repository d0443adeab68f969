//! A compact list of indices, and a union-find.

mod compact_indices;
mod union_find;

pub use compact_indices::CompactIndices;
pub use union_find::UnionFind;
