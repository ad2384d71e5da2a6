//! Values of materials that are out of their range.

use super::warnings::Warnings;

/// Returns a value that is in 0..=`most`; otherwise 0 or 1, with a warning unless the difference is only rounding. `whose` is the
/// subject of its sentence.
pub(super) fn within(value: f32, most: f32, whose: &str, warnings: &mut Warnings) -> f32 {
    let within = value.clamp(0.0, most);
    if (within - value).abs() < 1e-3 {
        return within;
    }
    let taken = if value < 0.0 { 0.0 } else { 1.0 };
    warnings.add(format!("{whose} cannot be {value}; {taken} is taken."));
    taken
}
