//! Uses of textures by a material: their UV sets and transforms.

use std::collections::BTreeSet;

use gltf::json;
use json::extensions::texture::TextureTransform;
use serde_json::{Map, Value};

use super::document::FINISHES;

/// glTF extension that transforms the coordinates of a texture.
pub(super) const TRANSFORM: &str = "KHR_texture_transform";

/// A use of a texture by a material.
pub(super) struct TextureUse {
    pub(super) uv_set: u32,
    /// `uv_in_texture = transform × (u, v, 1)`, rows.
    pub(super) transform: [[f32; 3]; 2],
    pub(super) is_normal_map: bool,
}

impl TextureUse {
    fn new(uv_set: u32, transform: Option<&TextureTransform>, is_normal_map: bool) -> TextureUse {
        TextureUse {
            uv_set: overridden(uv_set, transform),
            transform: rows(transform),
            is_normal_map,
        }
    }

    fn of_raw(raw: RawUse) -> TextureUse {
        TextureUse::new(raw.uv_set, raw_transform(raw.extensions).as_ref(), false)
    }
}

/// Returns the uses of textures by a material of the file: the normal map first, then base color, then the others.
pub(super) fn texture_uses(material: &json::Material) -> Vec<TextureUse> {
    let pbr = &material.pbr_metallic_roughness;
    let of_info = |info: &json::texture::Info| {
        let extensions = info.extensions.as_ref();
        let transform = extensions.and_then(|extensions| extensions.texture_transform.as_ref());
        TextureUse::new(info.tex_coord, transform, false)
    };
    let normal = material.normal_texture.as_ref().map(|normal| {
        let others = normal.extensions.as_ref().map(|extensions| &extensions.others);
        TextureUse::new(normal.tex_coord, raw_transform(others).as_ref(), true)
    });
    let occlusion = material.occlusion_texture.as_ref().map(|occlusion| {
        let others = occlusion.extensions.as_ref().map(|extensions| &extensions.others);
        TextureUse::new(occlusion.tex_coord, raw_transform(others).as_ref(), false)
    });
    let infos = [
        &pbr.base_color_texture,
        &pbr.metallic_roughness_texture,
        &material.emissive_texture,
    ];
    let finishes = raw_uses(material).map(TextureUse::of_raw);
    let infos = infos.into_iter().flatten().map(of_info);
    normal
        .into_iter()
        .chain(infos)
        .chain(occlusion)
        .chain(finishes)
        .collect()
}

/// Returns the uses of textures by a material, and after them the uses by all its extensions, even those that are not read:
/// a quantizer writes the same transform at each of them.
pub(super) fn all_texture_uses(material: &json::Material) -> Vec<TextureUse> {
    let extensions = material
        .extensions
        .iter()
        .flat_map(|extensions| extensions.others.values());
    let members = extensions.filter_map(Value::as_object);
    let further = members.flat_map(uses_in).map(|(_, used)| TextureUse::of_raw(used));
    texture_uses(material).into_iter().chain(further).collect()
}

/// The UV sets that the textures of a material use.
#[derive(Default)]
pub(super) struct GltfTextureUvSets {
    pub(super) all: BTreeSet<u32>,
    /// Set of its normal map.
    pub(super) normal: Option<u32>,
}

impl GltfTextureUvSets {
    /// Of a material of the file.
    pub(super) fn of(material: &json::Material) -> GltfTextureUvSets {
        let uses = texture_uses(material);
        GltfTextureUvSets {
            all: uses.iter().map(|used| used.uv_set).collect(),
            normal: uses.iter().find(|used| used.is_normal_map).map(|used| used.uv_set),
        }
    }
}

/// The members of one of the extensions of a material; empty where it has none.
pub(super) fn members<'m>(material: &'m json::Material, name: &str) -> Option<&'m Map<String, Value>> {
    let extensions = material.extensions.as_ref()?;
    extensions.others.get(name)?.as_object()
}

/// A use of a texture in one of the extensions, as glTF writes it.
pub(super) struct RawUse<'m> {
    pub(super) texture: usize,
    pub(super) uv_set: u32,
    pub(super) extensions: Option<&'m Map<String, Value>>,
}

/// Parses a use of a texture; `None` where it is invalid.
pub(super) fn raw_use(value: &Value) -> Option<RawUse<'_>> {
    Some(RawUse {
        texture: usize::try_from(value.get("index")?.as_u64()?).ok()?,
        uv_set: match value.get("texCoord") {
            Some(set) => u32::try_from(set.as_u64()?).ok()?,
            None => 0,
        },
        extensions: value.get("extensions").and_then(Value::as_object),
    })
}

/// All uses of textures that are read in the extensions of a material.
fn raw_uses(material: &json::Material) -> impl Iterator<Item = RawUse<'_>> {
    let extensions = FINISHES.into_iter().filter_map(|name| members(material, name));
    // The normal map of a coat is not read: the coat uses the normal map of the material.
    let read = extensions
        .flat_map(uses_in)
        .filter(|(key, _)| *key != "clearcoatNormalTexture");
    read.map(|(_, used)| used)
}

/// The uses of textures by an extension, each with its member.
fn uses_in(extension: &Map<String, Value>) -> impl Iterator<Item = (&str, RawUse<'_>)> {
    let named = extension.iter().filter(|(key, _)| key.ends_with("Texture"));
    named.filter_map(|(key, value)| Some((key.as_str(), raw_use(value)?)))
}

/// Parses a texture transform that the crate does not; `None` where there is none or it is invalid.
pub(super) fn raw_transform(others: Option<&Map<String, Value>>) -> Option<TextureTransform> {
    serde_json::from_value(others?.get(TRANSFORM)?.clone()).ok()
}

/// Returns the UV set of a texture, which KHR_texture_transform may override.
pub(super) fn overridden(uv_set: u32, transform: Option<&TextureTransform>) -> u32 {
    // If the transform names no UV set, the set of the texture applies.
    transform.and_then(|transform| transform.tex_coord).unwrap_or(uv_set)
}

/// Returns the matrix of a KHR_texture_transform: a scale, a rotation counter-clockwise in a picture (v grows downward), an
/// offset. The identity where there is none.
pub(super) fn rows(transform: Option<&TextureTransform>) -> [[f32; 3]; 2] {
    let Some(transform) = transform else {
        return [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    };
    let [scale_u, scale_v] = finite(transform.scale.0, 1.0);
    let [offset_u, offset_v] = finite(transform.offset.0, 0.0);
    let (sin, cos) = f64::from(finite([transform.rotation.0], 0.0)[0]).sin_cos();
    let (sin, cos) = (sin as f32, cos as f32);
    [
        [cos * scale_u, sin * scale_v, offset_u],
        [-sin * scale_u, cos * scale_v, offset_v],
    ]
}

/// Replaces values that are not finite numbers.
pub(super) fn finite<const N: usize>(values: [f32; N], otherwise: f32) -> [f32; N] {
    values.map(|value| if value.is_finite() { value } else { otherwise })
}
