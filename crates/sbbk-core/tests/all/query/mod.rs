//! Queries with one answer, against brute force in f64 over all pairs of triangles.

mod cast;
mod contacts;
mod departure;
mod nearest;
mod truth;
