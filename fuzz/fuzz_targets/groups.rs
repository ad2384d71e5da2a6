#![no_main]

#[path = "../bodies/graph.rs"]
mod graph;
#[path = "../bodies/groups.rs"]
mod groups;
#[path = "../bodies/parts.rs"]
mod parts;
#[path = "../bodies/planning.rs"]
mod planning;

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| groups::survives(bytes));
