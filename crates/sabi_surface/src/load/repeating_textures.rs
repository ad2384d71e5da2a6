//! Finds materials whose textures repeat, so that UVs outside of the unit square are not UDIM tiles.

use std::collections::BTreeSet;

use crate::model::{Model, TextureRef, Wrap};

/// First and last four-digit UDIM number that programs write into file names.
const UDIM_NUMBERS: std::ops::RangeInclusive<u32> = 1001..=1999;

/// Returns the materials with a texture that repeats on the chosen UV set. Images of a single UDIM tile do not count.
pub(super) fn repeating(model: &Model) -> BTreeSet<u32> {
    let repeats = |used: &TextureRef| {
        let picture = model.images.get(used.image);
        Some(used.uv_set) == model.mesh.uv_set
            && used.wrap.iter().any(|wrap| *wrap != Wrap::Clamp)
            && !picture.is_some_and(|picture| is_udim_picture(&picture.name))
    };
    let materials = model.materials.iter().enumerate();
    let found = materials.filter(|(_, material)| material.textures().any(repeats));
    found.map(|(index, _)| index as u32).collect()
}

/// Returns true if the name of an image contains a UDIM number or the placeholder for it.
fn is_udim_picture(name: &str) -> bool {
    let numbers = name.split(|letter: char| !letter.is_ascii_digit());
    let has_number = numbers
        .filter(|number| number.len() == 4)
        .any(|number| number.parse().is_ok_and(|number| UDIM_NUMBERS.contains(&number)));
    has_number || name.to_ascii_lowercase().contains("<udim>")
}

#[cfg(test)]
mod tests {
    use super::is_udim_picture;

    #[test]
    fn images_of_a_udim_tile_have_its_number_in_their_name() {
        for name in ["wall.1001.png", "wall_1042.exr", "wall.<UDIM>.png", "1999"] {
            assert!(is_udim_picture(name), "{name}");
        }
        for name in [
            "wall.png",
            "wall_2048.png",
            "wall_1000.png",
            "wall_11001.png",
            "image 3 of a.glb",
        ] {
            assert!(!is_udim_picture(name), "{name}");
        }
    }
}
