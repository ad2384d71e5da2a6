#![no_main]

#[path = "../bodies/cache.rs"]
mod cache;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| cache::survives(bytes));
