#![no_main]

#[path = "../bodies/linked.rs"]
mod linked;
#[path = "../bodies/planning.rs"]
mod planning;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| linked::survives(bytes));
