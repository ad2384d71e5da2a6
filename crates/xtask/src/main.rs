//! Set-up, tests, demo and assets.

fn main() {}
