//! Queries that want one answer about two meshes (distance, intersection, casts), stock Parry beside SBBK.
//!
//! Each mesh is asked about itself at *places*: crossing, hardly apart, near and far. Both dispatchers answer the
//! same questions in turn in one process; every answer judged is compared with brute force in f64.

mod answer;
mod export;
mod judge;
mod place;
mod plan;
mod report;

pub use answer::{Answered, Query};
pub use export::export;
pub use judge::QueryErrors;
pub use place::Place;
pub use plan::QueriesPlan;
pub use report::{Queries, QueryRow, QuerySide, queries};
