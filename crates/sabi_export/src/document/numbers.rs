//! Numbers as documents write them.

/// Numbers with commas between them, each as short as an f32 can be written.
pub(super) fn list(values: &[f32]) -> String {
    let numbers: Vec<String> = values.iter().map(f32::to_string).collect();
    numbers.join(", ")
}
