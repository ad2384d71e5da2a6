//! Blend materials
//! Puts one material over another by a mask; with Height blend, the higher of the two shows near the border.
//!
//! The mask says how likely the upper material is: its odds are m / (1 − m). Height blend multiplies these odds by
//! (1 + d) / (1 − d), where d is the difference of the heights divided by Height blend, limited to ±0.9. So a mask of 0
//! or 1 is followed exactly, the mask's border has no steps, and in between sand fills the cracks between stones. A small Height blend makes a crisp border; 0 ignores the heights.
//! @alias blend mix material over layer height shader
//! @use blend

struct Params {
    /// Difference of heights above which only the higher material shows; 0 ignores the heights.
    /// @length @range 0 100 @soft 0 0.05 @default 0
    height_blend: f32,
}

/// The material below, with the one above put over it.
/// @input below The material underneath. @optional
/// @input above The material put over it. @optional
/// @input mask Where the upper material lies. @optional @default 1
fn material(below: Material, above: Material, mask: f32, params: Params) -> Material {
    let difference = (above.height - below.height) / max(params.height_blend, 1e-9);
    let lead = select(0.0, 0.9 * clamp(difference, -1.0, 1.0), params.height_blend > 0.0);
    let share = blend_weight(mask, 1.0);
    let odds_above = share * (1.0 + lead);
    let weight = odds_above / (odds_above + (1.0 - share) * (1.0 - lead));
    return blend_material(below, above, weight);
}
