#![no_main]

#[path = "../bodies/copy.rs"]
mod copy;
#[path = "../bodies/parts.rs"]
mod parts;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| copy::survives(bytes));
