//! The dispatchers that are compared.

mod kind;
mod memory;

pub use kind::{Backend, Dispatcher, Installed, Primed, SharedDispatcher};
pub use memory::Memory;
pub use sbbk_testkit::probe::{Answer, Probe, Question, Recording, Reported, shape_address};
