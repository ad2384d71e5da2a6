//! The adapter that benches run on.

use std::env;

use sabi_engine::AdapterChoice;

/// Adapter that `SABI_ADAPTER` names as `--adapter` does, else the one that a user gets.
pub(crate) fn adapter() -> AdapterChoice {
    match env::var("SABI_ADAPTER") {
        Ok(name) => match name.parse() {
            Ok(choice) => choice,
            Err(never) => match never {},
        },
        Err(_) => AdapterChoice::Auto,
    }
}
