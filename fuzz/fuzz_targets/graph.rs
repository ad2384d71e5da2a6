#![no_main]

#[path = "../bodies/graph.rs"]
mod graph;
#[path = "../bodies/planning.rs"]
mod planning;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| graph::survives(bytes));
