//! WGSL text becomes node kinds: header, reflection, rules, linking.

pub mod kind;
