#![no_main]

#[path = "../bodies/node.rs"]
mod node;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| node::survives(bytes));
