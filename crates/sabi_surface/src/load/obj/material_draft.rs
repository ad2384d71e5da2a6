//! A material of a library (`.mtl`) while its statements are read and converted to metallic-roughness as far as possible.

use super::map_statement::MapStatement;
use crate::load::material_images::MaterialImages;
use crate::load::numbers::number;
use crate::load::opacity::{set_opacity, set_opacity_map};
use crate::load::value_range::within;
use crate::load::warnings::Warnings;
use crate::model::{ModelMaterial, TextureRef};

/// Keyword of a statement.
pub(super) struct Keyword<'k> {
    /// The keyword as written in the file.
    pub(super) written: &'k str,
    /// The keyword in lower case, since programs write both cases.
    pub(super) lower: String,
}

/// Statements of lighting models that have no counterpart in metallic-roughness. All files contain them.
const WITHOUT_COUNTERPART: [&str; 8] = ["ka", "ks", "ns", "ni", "tf", "illum", "sharpness", "km"];
/// Values of the extension for physically based materials that are not read. Programs usually write zeros.
const LAYERS: [&str; 5] = ["ps", "pc", "pcr", "aniso", "anisor"];
/// Statements that name an image and do not start with `map_`.
const MAPS: [&str; 5] = ["bump", "disp", "decal", "refl", "norm"];
/// Statements that name an image of heights.
const HEIGHTS: [&str; 4] = ["bump", "map_bump", "disp", "map_disp"];

/// Returns true for the keywords, in lower case, that a statement may have.
pub(super) fn is_known(keyword: &str) -> bool {
    let read = ["kd", "ke", "d", "tr", "pr", "pm", "map_aat"];
    let lists = [&read[..], &WITHOUT_COUNTERPART, &LAYERS, &MAPS];
    is_map(keyword) || lists.into_iter().flatten().any(|known| *known == keyword)
}

/// Returns true for the keywords of statements that name a picture.
fn is_map(keyword: &str) -> bool {
    // `map_aat` switches antialiasing of textures and names no image.
    keyword.starts_with("map_") && keyword != "map_aat" || MAPS.contains(&keyword)
}

/// A material whose statements are being read.
pub(super) struct MaterialDraft {
    material: ModelMaterial,
    /// Value of `d`, the opacity.
    opacity: Option<f32>,
    /// Value of `Tr`, which is 1 minus the opacity. It is used if there is no `d`.
    transparency: Option<f32>,
    /// Number of the image of `map_d`.
    opacity_map: Option<usize>,
    /// Number of the image of `map_Ka`, and the statement.
    ambient: Option<(usize, String)>,
}

impl MaterialDraft {
    pub(super) fn new(name: &str) -> MaterialDraft {
        MaterialDraft {
            material: ModelMaterial {
                name: name.to_owned(),
                ..ModelMaterial::plain()
            },
            opacity: None,
            transparency: None,
            opacity_map: None,
            ambient: None,
        }
    }

    /// Reads a statement.
    pub(super) fn statement(
        &mut self,
        keyword: &Keyword,
        rest: &str,
        pictures: &mut MaterialImages,
        warnings: &mut Warnings,
    ) {
        let whose = format!("`{}` of {}", keyword.written, self.material.label());
        if is_map(&keyword.lower) {
            return self.map(keyword, rest, &whose, pictures, warnings);
        }
        match keyword.lower.as_str() {
            "kd" | "ke" => {
                let Some([r, g, b]) = color(rest, warnings) else {
                    return warnings.add(format!("{whose} is no color of three numbers and is left out."));
                };
                // Emission has no upper limit.
                let most = if keyword.lower == "kd" { 1.0 } else { f32::MAX };
                let [r, g, b] = [r, g, b].map(|share| within(share, most, &whose, warnings));
                let material = &mut self.material;
                match keyword.lower.as_str() {
                    "kd" if material.base_color.is_none() => {
                        let [.., alpha] = material.base_color_factor;
                        material.base_color_factor = [r, g, b, alpha];
                    }
                    "ke" if material.emission.is_none() => material.emission_factor = [r, g, b],
                    // An image replaces the color.
                    _ => {}
                }
            }
            "d" | "tr" | "pr" | "pm" => {
                let value = rest
                    .strip_prefix("-halo")
                    .unwrap_or(rest)
                    .split_ascii_whitespace()
                    .next();
                let value = value
                    .and_then(|word| number(word, warnings))
                    .filter(|value| value.is_finite());
                let Some(value) = value else {
                    return warnings.add(format!("{whose} is no number and is left out."));
                };
                let value = within(value as f32, 1.0, &whose, warnings);
                let material = &mut self.material;
                match keyword.lower.as_str() {
                    "d" => self.opacity = Some(value),
                    "tr" => self.transparency = Some(value),
                    "pr" if material.roughness.is_none() => material.roughness_factor = value,
                    "pm" if material.metallic.is_none() => material.metallic_factor = value,
                    _ => {}
                }
            }
            layer if LAYERS.contains(&layer) => {
                let mut values = rest.split_ascii_whitespace().map_while(|word| number(word, warnings));
                if values.any(|value| value != 0.0) {
                    warnings.add(format!("{whose} is left out; glTF carries such values."));
                }
            }
            _ => {}
        }
    }

    /// Reads a statement that names an image. The image replaces the value, as in the programs that write these files.
    fn map(
        &mut self,
        keyword: &Keyword,
        rest: &str,
        whose: &str,
        pictures: &mut MaterialImages,
        warnings: &mut Warnings,
    ) {
        let lower = keyword.lower.as_str();
        let is_color = matches!(lower, "map_kd" | "map_ke");
        let statement = MapStatement::parse(rest, is_color, warnings);
        if statement.path.is_empty() {
            return warnings.add(format!("{whose} names no picture and is left out."));
        }
        let mut texture = || -> TextureRef {
            statement.warn(whose, warnings);
            statement.texture(pictures.beside(statement.path))
        };
        let material = &mut self.material;
        match lower {
            "map_kd" => {
                material.base_color = Some(texture());
                let [.., alpha] = material.base_color_factor;
                material.base_color_factor = [1.0, 1.0, 1.0, alpha];
            }
            "map_ke" => {
                material.emission = Some(texture());
                material.emission_factor = [1.0; 3];
            }
            "map_pr" => {
                material.roughness = Some(texture());
                material.roughness_factor = 1.0;
            }
            "map_pm" => {
                material.metallic = Some(texture());
                material.metallic_factor = 1.0;
            }
            "norm" | "map_norm" | "map_kn" => {
                material.normal = Some(texture());
                material.normal_scale = statement.bump;
            }
            "map_d" => self.opacity_map = Some(pictures.beside(statement.path)),
            "map_ka" => self.ambient = Some((pictures.beside(statement.path), whose.to_owned())),
            lower if HEIGHTS.contains(&lower) => {
                warnings.add(format!("{whose} is left out; glTF carries such maps."));
            }
            _ => warnings.add(format!("{whose} is left out.")),
        }
    }

    /// Returns the material after all statements were read.
    pub(super) fn finished(self, warnings: &mut Warnings) -> ModelMaterial {
        let mut material = self.material;
        let transparency = self.transparency.map(|transparency| 1.0 - transparency);
        let opacity = self.opacity.or(transparency);
        let base_color = material.base_color.as_ref().map(|base_color| base_color.image);
        if let Some((image, whose)) = self.ambient
            && base_color != Some(image)
        {
            // Programs often repeat the color image here, so a different image is reported.
            warnings.add(format!("{whose} is left out."));
        }
        if let Some(opacity) = opacity.filter(|opacity| *opacity < 1.0) {
            set_opacity(&mut material, opacity, warnings);
        }
        if let Some(image) = self.opacity_map {
            set_opacity_map(&mut material, image, warnings);
        }
        material
    }
}

/// Parses a color of one to three finite numbers; a single number is a gray.
fn color(rest: &str, warnings: &mut Warnings) -> Option<[f32; 3]> {
    let words = rest.split_ascii_whitespace();
    let values: Vec<f64> = words.map_while(|word| number(word, warnings)).collect();
    let color = match values[..] {
        [gray] => [gray; 3],
        [r, g, b, ..] => [r, g, b],
        _ => return None,
    };
    let color = color.map(|share| share as f32);
    color.iter().all(|share| share.is_finite()).then_some(color)
}
