//! The adapter on which benches run.

use std::env;

use sabi_gpu::AdapterChoice;

/// Returns the adapter that `SABI_ADAPTER` names in the form of `--adapter`, otherwise the one that a user gets.
pub(crate) fn adapter() -> AdapterChoice {
    match env::var("SABI_ADAPTER") {
        Ok(name) => match name.parse() {
            Ok(choice) => choice,
            Err(never) => match never {},
        },
        Err(_) => AdapterChoice::Auto,
    }
}
