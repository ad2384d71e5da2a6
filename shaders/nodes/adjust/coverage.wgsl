//! Coverage
//! Cuts a mask so that it covers a given share of the surface, on any model.
//!
//! The threshold is measured over the whole model, by its true area: the same amount of rust on a bench and on a
//! barrel, whatever their unwraps, sizes and noises. With Each, every part, piece or chart is measured for itself: each link
//! of a chain gets the same share. Up to 1024 are measured apart; of more, several share a measure.
//! @alias amount area threshold percent histogram scan balance
//! @use survey

struct Params {
    /// Share of the surface that is covered.
    /// @range 0 1 @default 0.3
    amount: f32,
    /// Softness of the border: the range of mask values over which it fades.
    /// @range 0 1 @default 0.1
    softness: f32,
    /// What is measured apart: nothing, or each part, piece or chart, so that each gets its own share.
    /// @choice whole part piece chart @default whole
    each: u32,
}

/// The value at which the mask is cut.
/// @pass 1 @surveys source params.each
fn threshold(survey: texture_2d_array<f32>, group: u32, params: Params) -> f32 {
    return survey_threshold_of(survey, group, params.amount, params.softness);
}

/// 1 where the surface is covered.
/// @input source The mask whose highest values are covered first.
fn mask(params: Params, source: f32, threshold: f32) -> f32 {
    return clamp((source - threshold) / max(params.softness, 1e-6) + 0.5, 0.0, 1.0);
}
