//! All tests of the interface without Rapier, in one binary.

mod draw;
mod plain_parry;
