//! Materials of the scene. Those of Blender, 3ds Max, Arnold and others are read by their metallic-roughness values, older
//! ones by diffuse color, shininess and transparency.

use std::collections::BTreeMap;

use ufbx::{Material, MaterialMap, Mesh, ShaderType};

use super::nodes::FbxMeshNode;
use super::textures::{FbxTextures, connected};
use crate::load::material_images::MaterialImages;
use crate::load::opacity::{set_opacity, set_opacity_map};
use crate::load::value_range::within;
use crate::load::warnings::Warnings;
use crate::model::{ModelMaterial, TextureRef};

/// Reader of materials.
pub(super) struct FbxMaterials<'s> {
    textures: FbxTextures<'s>,
    pub(super) pictures: MaterialImages,
    /// The first mesh that uses each material: textures refer to UV sets by the names in this mesh.
    mesh_of: BTreeMap<u32, &'s Mesh>,
}

impl<'s> FbxMaterials<'s> {
    /// `stem` is the name of the model's file without its ending.
    pub(super) fn new(scene: &'s ufbx::Scene, shown: &[FbxMeshNode<'s>], stem: String) -> FbxMaterials<'s> {
        let mut mesh_of = BTreeMap::new();
        for FbxMeshNode { node, mesh, .. } in shown {
            for material in &node.materials {
                mesh_of.entry(material.element.typed_id).or_insert(*mesh);
            }
        }
        FbxMaterials {
            textures: FbxTextures::new(scene, stem),
            pictures: MaterialImages::default(),
            mesh_of,
        }
    }

    /// Reads a material.
    pub(super) fn material(&mut self, material: &Material, warnings: &mut Warnings) -> ModelMaterial {
        let (pbr, fbx) = (&material.pbr, &material.fbx);
        let base = if is_given(&pbr.base_color) {
            &pbr.base_color
        } else {
            &fbx.diffuse_color
        };
        let mut look = ModelMaterial {
            name: material.element.name.to_string(),
            base_color: self.texture(material, base, "base color", warnings),
            normal: self.normal(material, warnings),
            occlusion: self.texture(material, &pbr.ambient_occlusion, "occlusion", warnings),
            emission: self.texture(material, &pbr.emission_color, "emission", warnings),
            ..ModelMaterial::plain()
        };
        let tint = if look.base_color.is_some() {
            [1.0; 3]
        } else {
            color(base, ModelMaterial::UNKNOWN_COLOR)
        };
        let whose = format!("The base color of {}", label(material));
        let factor = number(&pbr.base_factor, 1.0);
        let [r, g, b] = tint.map(|share| within(share * factor, 1.0, &whose, warnings));
        look.base_color_factor = [r, g, b, 1.0];
        let light = if look.emission.is_some() {
            [1.0; 3]
        } else {
            color(&pbr.emission_color, [0.0; 3])
        };
        let strength = number(&pbr.emission_factor, 1.0).max(0.0);
        look.emission_factor = light.map(|share| (share * strength).clamp(0.0, f32::MAX));
        if material.shader_type == ShaderType::BlenderPhong && look.normal.is_some() {
            look.normal_scale = number(&fbx.bump_factor, 1.0);
        }
        if material.features.double_sided.is_explicit {
            look.is_double_sided = material.features.double_sided.enabled;
        }
        self.read_surface(material, &mut look, warnings);
        self.read_opacity(material, &mut look, warnings);
        look
    }

    fn normal(&mut self, material: &Material, warnings: &mut Warnings) -> Option<TextureRef> {
        let (pbr, fbx) = (&material.pbr, &material.fbx);
        let map = if connected(&pbr.normal_map).is_some() {
            &pbr.normal_map
        } else {
            &fbx.normal_map
        };
        let normal = self.texture(material, map, "normal map", warnings);
        if normal.is_none() && connected(&fbx.bump).is_some() {
            warnings.add(format!(
                "The bump map of {} is left out: it is a height, not a normal map.",
                label(material)
            ));
        }
        normal
    }

    /// Reads roughness and metallic.
    fn read_surface(&mut self, material: &Material, look: &mut ModelMaterial, warnings: &mut Warnings) {
        let pbr = &material.pbr;
        let is_gloss = material.features.roughness_as_glossiness.enabled;
        // The shininess of older materials is an exponent. A map of it cannot be used as roughness.
        let is_power = matches!(material.shader_type, ShaderType::FbxPhong | ShaderType::Unknown);
        if connected(&pbr.glossiness).is_some() || is_power && connected(&pbr.roughness).is_some() {
            warnings.add(format!(
                "The gloss map of {} is left out; give it a roughness map.",
                label(material)
            ));
        } else {
            look.roughness = self.texture(material, &pbr.roughness, "roughness", warnings);
        }
        look.metallic = self.texture(material, &pbr.metalness, "metallic", warnings);
        look.roughness_factor = match look.roughness {
            Some(_) => 1.0,
            None if is_gloss => 1.0 - number(&pbr.glossiness, 0.0),
            None => number(&pbr.roughness, 1.0),
        };
        look.roughness_factor = look.roughness_factor.clamp(0.0, 1.0);
        look.metallic_factor = match look.metallic {
            Some(_) => 1.0,
            None => number(&pbr.metalness, 0.0).clamp(0.0, 1.0),
        };
        // If both use one image, it is packed as in game engines: roughness in G, metallic in B.
        if look.roughness.is_some() && look.roughness == look.metallic {
            look.metallic_roughness = look.roughness.take();
            look.metallic = None;
        }
    }

    fn read_opacity(&mut self, material: &Material, look: &mut ModelMaterial, warnings: &mut Warnings) {
        let (pbr, fbx) = (&material.pbr, &material.fbx);
        let maps = [&pbr.opacity, &fbx.transparency_factor, &fbx.transparency_color];
        let map = maps.into_iter().find(|map| connected(map).is_some());
        let opacity = if pbr.opacity.has_value {
            mean(color(&pbr.opacity, [1.0; 3]))
        } else {
            let amount = if fbx.transparency_factor.has_value || fbx.transparency_color.has_value {
                number(&fbx.transparency_factor, 1.0) * mean(color(&fbx.transparency_color, [1.0; 3]))
            } else {
                0.0
            };
            1.0 - amount
        };
        match map {
            Some(map) => match self.texture(material, map, "opacity", warnings) {
                Some(texture) => set_opacity_map(look, texture.image, warnings),
                None => look.ignores_alpha = look.base_color.is_some(),
            },
            None => set_opacity(look, opacity, warnings),
        }
    }

    fn texture(
        &mut self,
        material: &Material,
        map: &MaterialMap,
        what: &str,
        warnings: &mut Warnings,
    ) -> Option<TextureRef> {
        let texture = connected(map)?;
        let mesh = self.mesh_of.get(&material.element.typed_id).copied();
        let set = |name: &str| {
            let place = mesh.and_then(|mesh| mesh.uv_sets.iter().position(|set| *set.name == *name));
            // Textures often name no set, or one with another name. In these cases the first set is used.
            place.map_or(0, |place| place as u32)
        };
        let of = label(material);
        self.textures
            .used(texture, set, [what, &of], &mut self.pictures, warnings)
    }
}

fn label(material: &Material) -> String {
    format!("material `{}`", material.element.name)
}

fn is_given(map: &MaterialMap) -> bool {
    map.has_value || connected(map).is_some()
}

/// Returns the value if it is finite; `otherwise` if the file has no value.
fn number(map: &MaterialMap, otherwise: f32) -> f32 {
    let value = map.value_vec4.x as f32;
    if map.has_value && value.is_finite() {
        value
    } else {
        otherwise
    }
}

/// Returns the value if it is finite; `otherwise` if the file has no value.
fn color(map: &MaterialMap, otherwise: [f32; 3]) -> [f32; 3] {
    let value = [map.value_vec4.x, map.value_vec4.y, map.value_vec4.z].map(|share| share as f32);
    if map.has_value && value.iter().all(|share| share.is_finite()) {
        value
    } else {
        otherwise
    }
}

fn mean([r, g, b]: [f32; 3]) -> f32 {
    (r + g + b) / 3.0
}
