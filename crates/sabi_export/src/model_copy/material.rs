//! Materials of a loaded model, written as glTF.

use std::collections::{BTreeMap, BTreeSet};

use sabi_surface::model::{Model, ModelMaterial, TextureRef, Wrap};
use serde_json::{Value as Json, json};

use super::container::Container;
use super::edit::{TextureUse, push};
use super::numbers::short;
use super::picture_slots::media_type;

const NO_TRANSFORM: [[f32; 3]; 2] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

fn exact(values: &[f32]) -> Json {
    values.iter().map(|value| short(*value)).collect()
}

/// Writes the factors and textures of the loaded material into its JSON; `place` adds a texture and returns its use.
pub(super) fn write_material(
    material: &ModelMaterial,
    entry: &mut Json,
    place: &mut dyn FnMut(&Option<TextureRef>) -> Option<Json>,
) {
    // A separate image of metallic cannot be written, and most things are not metallic.
    let metallic = if material.metallic.is_some() {
        0.0
    } else {
        material.metallic_factor
    };
    entry["pbrMetallicRoughness"] = json!({
        "baseColorFactor": exact(&material.base_color_factor),
        "metallicFactor": short(metallic),
        "roughnessFactor": short(material.roughness_factor),
    });
    let highest = material.emission_factor.into_iter().fold(1.0, f32::max);
    if material.emission_factor != [0.0; 3] {
        entry["emissiveFactor"] = exact(&material.emission_factor.map(|factor| factor / highest));
    }
    if highest > 1.0 {
        entry["extensions"]["KHR_materials_emissive_strength"] = json!({ "emissiveStrength": short(highest) });
    }
    if material.base_color_factor[3] < 1.0 {
        entry["alphaMode"] = json!("BLEND");
    }
    for (key, texture) in [
        ("baseColorTexture", &material.base_color),
        ("metallicRoughnessTexture", &material.metallic_roughness),
    ] {
        if let Some(texture) = place(texture) {
            entry["pbrMetallicRoughness"][key] = texture;
        }
    }
    for (key, texture, strength) in [
        (
            "normalTexture",
            &material.normal,
            Some(("scale", material.normal_scale)),
        ),
        (
            "occlusionTexture",
            &material.occlusion,
            Some(("strength", material.occlusion_strength)),
        ),
        ("emissiveTexture", &material.emission, None),
    ] {
        let Some(mut texture) = place(texture) else { continue };
        if let Some((name, value)) = strength.filter(|(_, value)| *value != 1.0) {
            texture[name] = short(value);
        }
        entry[key] = texture;
    }
}

/// An image of the copy.
#[derive(Clone, Copy)]
struct CopiedImage {
    index: usize,
    /// Extension by which textures name an image of its format.
    extension: Option<&'static str>,
}

/// Textures of the model that a copy takes over.
pub(super) struct CopiedTextures<'m> {
    model: &'m Model,
    /// Images in the copy by image index of the model.
    images: BTreeMap<usize, CopiedImage>,
    /// Images of the model whose format glTF does not support.
    left_out: BTreeSet<usize>,
    /// Separate images of roughness or metallic, which glTF stores in one image.
    unpacked: BTreeSet<usize>,
}

impl<'m> CopiedTextures<'m> {
    pub(super) fn new(model: &'m Model) -> CopiedTextures<'m> {
        CopiedTextures {
            model,
            images: BTreeMap::new(),
            left_out: BTreeSet::new(),
            unpacked: BTreeSet::new(),
        }
    }

    /// Records the textures of a material that glTF cannot represent.
    pub(super) fn leave_unpacked(&mut self, material: &ModelMaterial) {
        let alone = [&material.roughness, &material.metallic].into_iter().flatten();
        self.unpacked.extend(alone.map(|texture| texture.image));
    }

    /// Returns a warning for each picture that was left out.
    pub(super) fn warnings(&self) -> impl Iterator<Item = String> {
        let format = "glTF has PNG, JPEG, WebP and KTX2 alone; save the picture as PNG and name that in the model";
        let packing = "glTF has roughness and metallic in one picture; bake that material as well";
        let left_out = self.left_out.iter().map(move |image| (image, format));
        let all = left_out.chain(self.unpacked.iter().map(move |image| (image, packing)));
        all.filter_map(|(image, why)| {
            let picture = self.model.images.get(*image)?;
            Some(format!(
                "the copy of the model does not show {}, a picture of a material that was not baked: {why}",
                picture.name
            ))
        })
    }

    /// Adds a texture and returns its use; `None` for pictures that glTF cannot hold, and for those of a UV set that the mesh
    /// does not have.
    pub(super) fn place(&mut self, used: &TextureRef, document: &mut Json, container: &mut Container) -> Option<Json> {
        self.model.mesh.set(used.uv_set)?;
        let image = self.image(used.image, document, container)?;
        let wrap = used.wrap.map(|wrap| match wrap {
            Wrap::Repeat => 10497,
            Wrap::Clamp => 33071,
            Wrap::Mirror => 33648,
        });
        let sampler = json!({ "wrapS": wrap[0], "wrapT": wrap[1] });
        let sampler = push(document, "samplers", sampler);
        let mut texture = json!({ "sampler": sampler });
        match image.extension {
            None => texture["source"] = json!(image.index),
            Some(extension) => {
                texture["extensions"][extension] = json!({ "source": image.index });
                require(document, extension);
            }
        }
        let texture = TextureUse {
            index: push(document, "textures", texture),
            uv_set: used.uv_set,
            decoding: None,
        };
        let mut texture = texture.to_json();
        if used.transform != NO_TRANSFORM {
            texture["extensions"]["KHR_texture_transform"] = transform(used.transform);
        }
        Some(texture)
    }

    fn image(&mut self, image: usize, document: &mut Json, container: &mut Container) -> Option<CopiedImage> {
        if let Some(place) = self.images.get(&image) {
            return Some(*place);
        }
        let picture = self.model.images.get(image)?;
        let bytes = picture.bytes.as_ref().ok()?;
        let Some(kind) = media_type(bytes) else {
            self.left_out.insert(image);
            return None;
        };
        let extension = match kind {
            "image/webp" => Some("EXT_texture_webp"),
            "image/ktx2" => Some("KHR_texture_basisu"),
            _ => None,
        };
        let view = container.put(bytes)?;
        let view = push(document, "bufferViews", view);
        let entry = json!({ "name": picture.name, "mimeType": kind, "bufferView": view });
        let index = push(document, "images", entry);
        let copied = CopiedImage { index, extension };
        self.images.insert(image, copied);
        Some(copied)
    }
}

/// Lists an extension without which the document cannot be shown.
fn require(document: &mut Json, extension: &str) {
    let required = document["extensionsRequired"].as_array();
    if !required.is_some_and(|names| names.iter().any(|name| name == extension)) {
        push(document, "extensionsRequired", json!(extension));
    }
}

/// Returns a matrix as KHR_texture_transform: a scale, a rotation by an angle θ, an offset. The columns of the matrix are
/// (cos θ, −sin θ) and (sin θ, cos θ), each times a scale.
fn transform([[a, b, u], [c, d, v]]: [[f32; 3]; 2]) -> Json {
    let angle = (-c).atan2(a);
    let (sin, cos) = angle.sin_cos();
    json!({
        "offset": exact(&[u, v]),
        "rotation": short(angle),
        "scale": exact(&[a.hypot(c), b * sin + d * cos]),
    })
}
