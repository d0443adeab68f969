//! The contact generator judged by the brute-force reference.

mod check;
mod clip;
mod hard_cases;
mod lattice;
mod random;
