#![no_main]

#[path = "../bodies/graph.rs"]
mod graph;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| graph::survives(bytes));
