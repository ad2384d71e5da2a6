//! Opacity of materials in formats whose programs disagree about it.

use super::warnings::Warnings;
use crate::model::ModelMaterial;

/// Gives a material the opacity that its file says, 0 to 1, and the shared rule for 0: programs disagree about the meaning of
/// transparency, and nobody bakes a model that cannot be seen, so that it is taken as opaque, with a warning.
pub(super) fn set_opacity(material: &mut ModelMaterial, opacity: f32, warnings: &mut Warnings) {
    let opacity = opacity.clamp(0.0, 1.0);
    material.ignores_alpha = opacity == 0.0 || opacity >= 1.0;
    if opacity > 0.0 {
        material.base_color_factor[3] = opacity;
    } else {
        warnings.add(format!(
            "The file has {} invisible; it is taken as opaque.",
            material.label()
        ));
    }
}

/// Gives a material the opacity of a picture, an image of it: the alpha of its base color's own is read, and no other.
pub(super) fn set_opacity_map(material: &mut ModelMaterial, image: usize, warnings: &mut Warnings) {
    let own = material.base_color.as_ref().map(|own| own.image);
    material.ignores_alpha = own != Some(image);
    if material.ignores_alpha {
        warnings.add(format!(
            "The opacity map of {} is left out: opacity is read from the alpha of its base color's picture.",
            material.label()
        ));
    }
}
