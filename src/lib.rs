//! SBBK for Rapier: this package holds the examples and the integration tests of the workspace.
//! The library to depend on is [`rapier_integration`]; the trees themselves are in [`sbbk_core`].
