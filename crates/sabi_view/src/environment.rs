//! Light from all around.
