//! Opacity of materials in formats whose programs interpret it differently.

use super::warnings::Warnings;
use crate::model::ModelMaterial;

/// Sets the opacity of a material to the file's value, 0 to 1. A value of 0 is replaced by 1, with a warning: programs
/// disagree about the meaning of transparency, and there is no reason to bake an invisible model.
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

/// Uses an image as opacity of a material. Only the alpha of the base color image can be read.
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
