#![no_main]

#[path = "../bodies/linked.rs"]
mod linked;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| linked::survives(bytes));
