//! Materials that are used, their textures, and the images of these.

mod finish;

use std::collections::BTreeMap;

use gltf::json;
use json::material::AlphaMode;
use json::texture::WrappingMode;
use json::validation::Checked;
use serde_json::{Map, Value};

use super::Resolve;
use super::picture::GltfImageCache;
use super::source::GltfSource;
use super::texture_use::{TRANSFORM, finite, overridden, raw_transform, rows};
use super::uv_decoding::UvDecodings;
use crate::load::value_range::within;
use crate::load::warnings::Warnings;
use crate::model::{Model, ModelMaterial, TextureRef, Wrap};

/// Extensions that store the image of a texture elsewhere, and whether images of that format are supported.
const OTHER_SOURCES: [(&str, bool); 4] = [
    ("EXT_texture_webp", true),
    ("KHR_texture_basisu", true),
    ("EXT_texture_avif", false),
    ("MSFT_texture_dds", false),
];

/// Extension of an older material model, which some files use instead of metallic-roughness.
const SPECULAR_GLOSSINESS: &str = "KHR_materials_pbrSpecularGlossiness";

/// The materials that triangles use, numbered in order of first use until [`Materials::finish`] sorts them in file order.
#[derive(Default)]
pub(super) struct Materials {
    /// Slot of each material. The key of the default material is the last.
    slots: BTreeMap<(bool, usize), u32>,
}

impl Materials {
    /// Returns the slot of a material of the file; `None` stands for the default material.
    pub(super) fn slot(&mut self, material: Option<usize>) -> u32 {
        let next = self.slots.len() as u32;
        *self
            .slots
            // The first part of the key already distinguishes glTF's default material.
            .entry((material.is_none(), material.unwrap_or(0)))
            .or_insert(next)
    }

    /// Returns the index in file order that [`Materials::finish`] assigns to a material; `None` if no triangle uses it.
    pub(super) fn place(&self, material: Option<usize>) -> Option<u32> {
        let places = self.slots.keys();
        // The first part of the key already distinguishes glTF's default material.
        let key = (material.is_none(), material.unwrap_or(0));
        places
            .zip(0..)
            .find(|(other, _)| **other == key)
            .map(|(_, place)| place)
    }

    /// Reads the materials that are used and their images into `model`, and sorts the triangles' materials in file order.
    pub(super) fn finish(
        self,
        source: &GltfSource,
        decodings: &UvDecodings,
        name: &str,
        resolve: &mut Resolve,
        model: &mut Model,
        warnings: &mut Warnings,
    ) {
        let mut new_from_slot = vec![0; self.slots.len()];
        let mut pictures = GltfImages {
            source,
            slots: BTreeMap::new(),
            warnings,
        };
        for (new, ((is_default, index), slot)) in self.slots.into_iter().enumerate() {
            new_from_slot[slot as usize] = new as u32;
            let material = source.document.materials.get(index).filter(|_| !is_default);
            let mut material =
                material.map_or_else(ModelMaterial::default, |material| pictures.material(index, material));
            material.uv_decoding = decodings.of(material.file_index);
            if let Some(decoding) = material.uv_decoding {
                let on_set = material.textures_mut().filter(|used| used.uv_set == source.uv_set);
                on_set.for_each(|used| used.transform = decoding.undone(used.transform));
            }
            model.materials.push(material);
        }
        for material in &mut model.mesh.triangle_material {
            *material = new_from_slot[*material as usize];
        }
        let mut slots: Vec<_> = pictures.slots.into_iter().collect();
        slots.sort_unstable_by_key(|(_, slot)| *slot);
        let mut cache = GltfImageCache::default();
        for ((image, unread), _) in slots {
            let image = cache.read(source, name, image, unread, resolve);
            if let Err(sentence) = &image.bytes {
                warnings.add(sentence.clone());
            }
            model.images.push(image);
        }
    }
}

/// Images in the order in which materials refer to them.
struct GltfImages<'a> {
    source: &'a GltfSource<'a>,
    /// Index in the model, by the image of the file and whether it is in an unsupported format.
    slots: BTreeMap<(usize, Option<&'static str>), usize>,
    warnings: &'a mut Warnings,
}

/// Properties common to all kinds of texture use.
struct GltfTextureRef<'a> {
    texture: usize,
    uv_set: u32,
    transform: Option<&'a json::extensions::texture::TextureTransform>,
}

impl GltfImages<'_> {
    fn material(&mut self, index: usize, material: &json::Material) -> ModelMaterial {
        let pbr = &material.pbr_metallic_roughness;
        let label = self.source.document.material_label(Some(index));
        let others = material.extensions.as_ref().map(|extensions| &extensions.others);
        if others.is_some_and(|others| others.contains_key(SPECULAR_GLOSSINESS)) {
            self.warnings.add(format!(
                "The {label} is described by {SPECULAR_GLOSSINESS}, which is not read here; its metallic-roughness values are taken."
            ));
        }
        let normal = material.normal_texture.as_ref();
        let occlusion = material.occlusion_texture.as_ref();
        let base_color_factor = self.within(pbr.base_color_factor.0, 1.0, "base color", &label);
        let [metallic_factor] = self.within([pbr.metallic_factor.0], 1.0, "metallic factor", &label);
        let [roughness_factor] = self.within([pbr.roughness_factor.0], 1.0, "roughness factor", &label);
        let emission_factor = self.emission_factor(material, &label);
        let strength_of_occlusion = occlusion.map_or(1.0, |occlusion| occlusion.strength.0);
        let [occlusion_strength] = self.within([strength_of_occlusion], 1.0, "occlusion strength", &label);
        let mut info = |info: &Option<json::texture::Info>| info.as_ref().and_then(|info| self.info(&label, info));
        let base_color = info(&pbr.base_color_texture);
        let metallic_roughness = info(&pbr.metallic_roughness_texture);
        let emission = info(&material.emissive_texture);
        let finish = self.finish(material, &label);
        let ignores_alpha = matches!(material.alpha_mode, Checked::Valid(AlphaMode::Opaque));
        let is_masked = matches!(material.alpha_mode, Checked::Valid(AlphaMode::Mask));
        // 0.5 where the file says nothing (glTF 2.0, 3.9.4).
        let alpha_cutoff = is_masked.then(|| material.alpha_cutoff.unwrap_or_default().0);
        // A texture makes alpha only smaller.
        let [.., most] = base_color_factor;
        let reason = match alpha_cutoff {
            Some(cutoff) if most < cutoff => Some("its alpha is below its cutoff"),
            None if most == 0.0 && !ignores_alpha => Some("its alpha is 0"),
            _ => None,
        };
        if let Some(reason) = reason {
            // The format defines the meaning of alpha, so the file is followed.
            self.warnings.add(format!("The file has {label} invisible: {reason}."));
        }
        ModelMaterial {
            // A name is optional in glTF; an empty one means unnamed.
            name: material.name.clone().unwrap_or_default(),
            file_index: Some(index),
            uv_decoding: None,
            base_color_factor,
            ignores_alpha,
            alpha_cutoff,
            is_double_sided: material.double_sided,
            metallic_factor,
            roughness_factor,
            emission_factor,
            normal_scale: normal.map_or(1.0, |normal| finite([normal.scale], 1.0)[0]),
            occlusion_strength,
            base_color,
            metallic_roughness,
            emission,
            finish,
            normal: normal.and_then(|normal| {
                let others = normal.extensions.as_ref().map(|extensions| &extensions.others);
                self.with_raw_transform(&label, normal.index.value(), normal.tex_coord, others)
            }),
            occlusion: occlusion.and_then(|occlusion| {
                let others = occlusion.extensions.as_ref().map(|extensions| &extensions.others);
                self.with_raw_transform(&label, occlusion.index.value(), occlusion.tex_coord, others)
            }),
            ..ModelMaterial::default()
        }
    }

    fn emission_factor(&mut self, material: &json::Material, label: &str) -> [f32; 3] {
        // Factors above 1, which glTF forbids, were used before the extension for emission strength existed.
        let factor = self.within(material.emissive_factor.0, f32::MAX, "emission", label);
        let extensions = material.extensions.as_ref();
        let strength = extensions.and_then(|extensions| extensions.emissive_strength.as_ref());
        let strength = strength.map_or(1.0, |strength| strength.emissive_strength.0);
        let [strength] = self.within([strength], f32::MAX, "emission strength", label);
        finite(factor.map(|factor| factor * strength), 0.0)
    }

    /// Clamps factors to 0..=`most`, with a warning unless the difference is only rounding.
    fn within<const N: usize>(&mut self, factors: [f32; N], most: f32, what: &str, label: &str) -> [f32; N] {
        let whose = format!("The {what} of {label}");
        factors.map(|factor| within(factor, most, &whose, self.warnings))
    }

    fn info(&mut self, label: &str, info: &json::texture::Info) -> Option<TextureRef> {
        let transform = info
            .extensions
            .as_ref()
            .and_then(|extensions| extensions.texture_transform.as_ref());
        self.texture(
            label,
            GltfTextureRef {
                texture: info.index.value(),
                uv_set: info.tex_coord,
                transform,
            },
        )
    }

    /// Returns a normal or occlusion texture, whose transform the crate does not parse.
    fn with_raw_transform(
        &mut self,
        label: &str,
        texture: usize,
        uv_set: u32,
        others: Option<&Map<String, Value>>,
    ) -> Option<TextureRef> {
        let transform = raw_transform(others);
        if transform.is_none() && others.is_some_and(|others| others.contains_key(TRANSFORM)) {
            self.warnings.add(format!(
                "A texture transform of {label} cannot be read and is left out."
            ));
        }
        self.texture(
            label,
            GltfTextureRef {
                texture,
                uv_set,
                transform: transform.as_ref(),
            },
        )
    }

    fn texture(&mut self, label: &str, used: GltfTextureRef) -> Option<TextureRef> {
        let document = self.source.document;
        let index = used.texture;
        let Some(texture) = document.textures.get(index) else {
            self.warnings.add(format!(
                "A texture of {label} is left out: there is no textures[{index}]."
            ));
            return None;
        };
        let others = texture.extensions.as_ref().map(|extensions| &extensions.others);
        let other = OTHER_SOURCES.into_iter().find_map(|(name, is_read)| {
            let image = others?.get(name)?.get("source")?.as_u64()?;
            Some((usize::try_from(image).ok()?, (!is_read).then_some(name)))
        });
        let plain = Some((texture.source.value(), None)).filter(|(image, _)| *image < document.images.len());
        let Some(picture) = plain.or(other.filter(|(image, _)| *image < document.images.len())) else {
            self.warnings.add(format!(
                "A texture of {label} is left out: textures[{index}] has no picture."
            ));
            return None;
        };
        let next = self.slots.len();
        let image = *self.slots.entry(picture).or_insert(next);
        let sampler = texture.sampler.and_then(|sampler| {
            let found = document.samplers.get(sampler.value());
            if found.is_none() {
                self.warnings.add(format!(
                    "A texture of {label} is repeated: there is no samplers[{}] to say otherwise.",
                    sampler.value()
                ));
            }
            found
        });
        Some(TextureRef {
            image,
            wrap: sampler.map_or([Wrap::Repeat; 2], |sampler| {
                [wrap(sampler.wrap_s), wrap(sampler.wrap_t)]
            }),
            transform: rows(used.transform),
            uv_set: overridden(used.uv_set, used.transform),
        })
    }
}

fn wrap(mode: Checked<WrappingMode>) -> Wrap {
    match mode {
        Checked::Valid(WrappingMode::ClampToEdge) => Wrap::Clamp,
        Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::Mirror,
        Checked::Valid(WrappingMode::Repeat) | Checked::Invalid => Wrap::Repeat,
    }
}
