//! Auto levels
//! Stretches a mask so that it uses the whole range from black to white, on any model.
//!
//! The ends are measured over the whole model, by its true area, or with Each over every part, piece or chart. Up to 1024 are
//! measured apart; of more, several share a measure.
//! @alias normalize stretch contrast histogram auto
//! @use survey

struct Params {
    /// Share of the surface that becomes black.
    /// @range 0 1 @soft 0 0.2 @default 0.02
    low: f32,
    /// Share of the surface that does not become white.
    /// @range 0 1 @soft 0.8 1 @default 0.98
    high: f32,
    /// What is measured apart: nothing, or each part, piece or chart, so that each gets its own share.
    /// @choice whole part piece chart @default whole
    each: u32,
}

/// The value that becomes black.
/// @pass 1 @surveys source params.each
fn black(survey: texture_2d_array<f32>, group: u32, params: Params) -> f32 {
    return survey_value_of(survey, group, params.low);
}

/// The value that becomes white.
/// @pass 2 @surveys source params.each
fn white(survey: texture_2d_array<f32>, group: u32, params: Params) -> f32 {
    return survey_value_of(survey, group, params.high);
}

/// The stretched mask.
/// @input source The mask to stretch.
fn mask(source: f32, black: f32, white: f32) -> f32 {
    return clamp((source - black) / max(white - black, 1e-6), 0.0, 1.0);
}
