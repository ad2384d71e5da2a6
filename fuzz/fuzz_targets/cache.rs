#![no_main]

#[path = "../bodies/cache.rs"]
mod cache;
#[path = "../bodies/square.rs"]
mod square;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cache::survives(bytes));
