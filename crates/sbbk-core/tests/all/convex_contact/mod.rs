//! The contact of a triangle and a convex shape against brute force with other formulas.

mod clip;
mod closed;
mod curved;
mod degenerate;
mod drawn;
mod invariance;
mod random;
mod shape;
mod truth;
