//! Channels and modes that the model can be shown in.

use sabi_view::Mode;

/// Channels of a material with their titles: first all of them in their light, then one by one.
pub(crate) const CHANNELS: [(&str, Mode); 17] = [
    ("Material", Mode::Material),
    ("Base color", Mode::BaseColor),
    ("Opacity", Mode::Opacity),
    ("Roughness", Mode::Roughness),
    ("Metallic", Mode::Metallic),
    ("Occlusion", Mode::Occlusion),
    ("Height", Mode::Height),
    ("Normal", Mode::Normal),
    ("Model-space normal", Mode::ModelNormal),
    ("Emission", Mode::Emission),
    ("Clear coat", Mode::Coat),
    ("Coat roughness", Mode::CoatRoughness),
    ("Anisotropy", Mode::Anisotropy),
    ("Sheen", Mode::Sheen),
    ("Sheen roughness", Mode::SheenRoughness),
    ("Subsurface", Mode::Subsurface),
    ("Transmission", Mode::Transmission),
];

/// Modes that show the model itself, with their titles.
pub(super) const MODEL_MODES: [(&str, Mode); 4] = [
    ("Checker", Mode::Checker),
    ("Texel density", Mode::Density),
    ("Face orientation", Mode::Facing),
    ("Clay", Mode::Clay),
];

/// Title of a mode.
pub(super) fn title(mode: Mode) -> &'static str {
    let mut all = CHANNELS.iter().chain(&MODEL_MODES);
    all.find(|(_, known)| *known == mode)
        .map_or("Material", |(title, _)| title)
}

/// Channel that is `steps` after a mode; the first one, if the mode shows no channel.
pub(super) fn after(mode: Mode, steps: isize) -> Mode {
    let at = CHANNELS.iter().position(|(_, known)| *known == mode);
    let next = at.map_or(0, |at| (at as isize + steps).rem_euclid(CHANNELS.len() as isize));
    CHANNELS[next as usize].1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_follow_each_other_in_a_circle() {
        assert_eq!(after(Mode::Material, 1), Mode::BaseColor);
        assert_eq!(after(Mode::Material, -1), Mode::Transmission);
        assert_eq!(after(Mode::Transmission, 1), Mode::Material);
        assert_eq!(after(Mode::Clay, 1), Mode::Material);
        assert_eq!((title(Mode::Height), title(Mode::Clay)), ("Height", "Clay"));
    }
}
