//! The preset `raw`: one file a channel, nothing packed.

use super::{Codes, Format, Holds, Map, Preset, When};
use crate::Channel;

const fn png(bits: u8, codes: Codes, dither: bool) -> Format {
    Format::Png { bits, codes, dither }
}

/// One file for each channel. Colors are 8-bit sRGB, factors 8 bit, normals (Y+) and masks 16 bit; height is exact floats and, for
/// programs without OpenEXR, 16 bit over its range; emission gets a float file beside it where it exceeds 1. Coat, anisotropy,
/// sheen and what is below the surface are written for materials that have them.
pub fn raw() -> Preset {
    let always = |channel, format| Map {
        holds: Holds::Channel(channel),
        format,
        when: When::Always,
    };
    Preset {
        name: "raw".into(),
        maps: vec![
            always(Channel::BaseColor, png(8, Codes::Srgb, false)),
            // Not dithered: renderers cut it at a threshold.
            always(Channel::Opacity, png(8, Codes::Unit, false)),
            always(Channel::Roughness, png(8, Codes::Unit, true)),
            always(Channel::Metallic, png(8, Codes::Unit, true)),
            always(Channel::Occlusion, png(8, Codes::Unit, true)),
            always(Channel::Height, Format::Exr),
            always(Channel::Height, png(16, Codes::Range, false)),
            always(Channel::Normal, png(16, Codes::Signed, false)),
            always(Channel::Emission, png(8, Codes::Srgb, false)),
            Map {
                holds: Holds::Channel(Channel::Emission),
                format: Format::Exr,
                when: When::AboveOne,
            },
            always(Channel::Coat, png(8, Codes::Unit, true)),
            always(Channel::CoatRoughness, png(8, Codes::Unit, true)),
            // Not dithered: directions would flicker.
            always(Channel::Anisotropy, png(8, Codes::Unit, false)),
            always(Channel::Sheen, png(8, Codes::Srgb, false)),
            always(Channel::SheenRoughness, png(8, Codes::Unit, true)),
            always(Channel::Subsurface, png(8, Codes::Srgb, false)),
            always(Channel::Transmission, png(8, Codes::Unit, true)),
            Map {
                holds: Holds::EveryMask,
                format: png(16, Codes::Unit, false),
                when: When::Always,
            },
        ],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::NamePattern;

    #[test]
    fn every_channel_has_its_file_under_the_promised_name() {
        let preset = raw();
        let mask = Channel::Mask("wear".into());
        let names: Vec<String> = Channel::ALL
            .iter()
            .chain([&mask])
            .flat_map(|channel| {
                let stem = NamePattern::default().stem("wood", channel);
                preset.maps_of(channel).map(move |map| map.file_name(&stem, None))
            })
            .collect();
        assert_eq!(
            names,
            [
                "wood_base_color.png",
                "wood_opacity.png",
                "wood_roughness.png",
                "wood_metallic.png",
                "wood_occlusion.png",
                "wood_height.exr",
                "wood_height.png",
                "wood_normal.png",
                "wood_emission.png",
                "wood_emission.exr",
                "wood_coat.png",
                "wood_coat_roughness.png",
                "wood_anisotropy.png",
                "wood_sheen.png",
                "wood_sheen_roughness.png",
                "wood_subsurface.png",
                "wood_transmission.png",
                "wood_wear.png"
            ]
        );
        assert_eq!(
            preset.maps[0].file_name("wood_base_color", Some(1012)),
            "wood_base_color.1012.png"
        );
    }
}
