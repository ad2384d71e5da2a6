//! `source/model`: the model's own textures and factors on the atlas.

use std::ops::Range;

use sabi_gpu::{GpuError, SourceCanvas, TileSet};
use sabi_graph::PortType;
use sabi_nodes::kind::Channel;
use sabi_nodes::link::Plane;
use sabi_plan::{SourceKind, SourcePort};
use sabi_surface::model::{Model, ModelMaterial, TextureRef};

use super::hash_apart;
use super::material_canvas::{CoordinateTables, MaterialCanvas};
use super::mip_chain::{PixelCurve, PixelReading};
use super::model_finish::{self, FinishTextures};
use super::model_pictures::open_pictures;
use super::model_textures::{ModelTexture, Product};
use super::session_pictures::SessionPictures;
use super::texels::SourceSurface;

/// Id of the kind.
pub(crate) const NAME: &str = "source/model";

/// Declares the kind. Without a model, its material sets only color and surface.
pub(crate) fn kind() -> SourceKind {
    SourceKind {
        id: NAME.to_owned(),
        label: "Model".to_owned(),
        summary: "The model's own textures and factors, including its normal map.".to_owned(),
        aliases: ["texture", "original", "mesh"].map(str::to_owned).to_vec(),
        params: Vec::new(),
        inputs: Vec::new(),
        outputs: vec![
            SourcePort::material(
                "material",
                PortType::Material,
                "All of it.",
                &[Channel::Color, Channel::Surface],
            ),
            SourcePort::new("base_color", PortType::Color, "Base color."),
            SourcePort::new("alpha", PortType::Mask, "Opacity."),
            SourcePort::new("roughness", PortType::Mask, "Roughness."),
            SourcePort::new("metallic", PortType::Mask, "Metallic."),
            SourcePort::new("occlusion", PortType::Mask, "Occlusion: 1 is open."),
            SourcePort::new(
                "slope",
                PortType::Vector,
                "The normal map as a surface gradient in model space.",
            ),
            SourcePort::new("emission", PortType::Color, "Emission."),
        ],
        content: [0; 32],
    }
}

/// Colors whose alpha, if there is one, has no meaning.
const COLORS: PixelReading = PixelReading {
    curve: PixelCurve::Srgb,
    by_alpha: false,
};
/// Values that are no colors.
const VALUES: PixelReading = PixelReading {
    curve: PixelCurve::Linear,
    by_alpha: false,
};

/// Textures of one material.
struct MaterialTextures<'a> {
    material: &'a ModelMaterial,
    base_color: Option<ModelTexture<'a>>,
    metallic_roughness: Option<ModelTexture<'a>>,
    roughness: Option<ModelTexture<'a>>,
    metallic: Option<ModelTexture<'a>>,
    normal: Option<ModelTexture<'a>>,
    occlusion: Option<ModelTexture<'a>>,
    emission: Option<ModelTexture<'a>>,
    finish: FinishTextures<'a>,
}

impl MaterialTextures<'_> {
    /// Draws a plane of a result where triangles have the material.
    fn draw(&self, canvas: &mut MaterialCanvas<'_>, output: &str, plane: Plane) -> Result<(), GpuError> {
        let products = match (plane, output) {
            (Plane::Material(Channel::Slope), _) | (Plane::Vector, _) => {
                return canvas.directions(self.normal.as_ref(), self.material.normal_scale, None);
            }
            (Plane::Material(Channel::Anisotropy), _) => {
                let (texture, strength, rotation) = self.finish.anisotropy();
                return canvas.directions(texture, strength, Some(rotation));
            }
            (Plane::Material(Channel::Color), _) => self.base_color(),
            (Plane::Material(Channel::Surface), _) => self.surface(),
            // It declares no height.
            (Plane::Material(Channel::Height), _) => [Product::constant(0.0); 4],
            (Plane::Material(Channel::Coat), _) => self.finish.coat(),
            (Plane::Material(Channel::Sheen), _) => self.finish.sheen(),
            (Plane::Material(Channel::Subsurface), _) => self.finish.subsurface(),
            (Plane::Material(Channel::Emission), _) | (Plane::Color, "emission") => self.emission(),
            (Plane::Color, _) => {
                let [r, g, b, _] = self.base_color();
                [r, g, b, Product::constant(1.0)]
            }
            (Plane::Mask, "alpha") => [self.base_color()[3]; 4],
            (Plane::Mask, "roughness") => [self.surface()[0]; 4],
            (Plane::Mask, "metallic") => [self.surface()[1]; 4],
            (Plane::Mask, _) => [self.surface()[2]; 4],
        };
        canvas.products(products)
    }

    /// Base color and alpha.
    fn base_color(&self) -> [Product<'_>; 4] {
        let factor = self.material.base_color_factor;
        let mut color = std::array::from_fn(|channel| Product::of(&self.base_color, channel as u32, factor[channel]));
        if self.material.ignores_alpha {
            color[3] = Product::constant(1.0);
        }
        color[3].cutoff = self.material.alpha_cutoff;
        color
    }

    /// Roughness, metallic and occlusion.
    fn surface(&self) -> [Product<'_>; 4] {
        let material = self.material;
        let strength = material.occlusion_strength;
        [
            Product::of(&self.metallic_roughness, 1, material.roughness_factor).times(&self.roughness, 0),
            Product::of(&self.metallic_roughness, 2, material.metallic_factor).times(&self.metallic, 0),
            Product {
                addend: 1.0 - strength,
                ..Product::of(&self.occlusion, 0, strength)
            },
            Product::constant(1.0),
        ]
    }

    fn emission(&self) -> [Product<'_>; 4] {
        let [r, g, b] = self.material.emission_factor;
        [
            Product::of(&self.emission, 0, r),
            Product::of(&self.emission, 1, g),
            Product::of(&self.emission, 2, b),
            Product::constant(1.0),
        ]
    }
}

/// Declares the kind for a model: with the channels that its material sets, and a hash of its textures and factors.
pub(crate) fn kind_for(model: &Model) -> SourceKind {
    let mut kind = kind();
    let mut hash = blake3::Hasher::new();
    for image in &model.images {
        match &image.bytes {
            Ok(bytes) => hash_apart(&mut hash, blake3::hash(bytes).as_bytes()),
            Err(why) => hash_apart(&mut hash, why.as_bytes()),
        }
    }
    hash_apart(&mut hash, format!("{:?}", model.materials).as_bytes());
    hash_apart(&mut hash, format!("{:?}", model.mesh.missing_uvs).as_bytes());
    for other in &model.mesh.texture_uvs {
        hash.update(&other.set.to_le_bytes());
        hash.update(&(other.uvs.len() as u64).to_le_bytes());
        for uv in &other.uvs {
            hash.update(uv.map(f32::to_le_bytes).as_flattened());
        }
        hash.update(&(other.tangents.len() as u64).to_le_bytes());
        for tangent in &other.tangents {
            hash.update(tangent.map(f32::to_le_bytes).as_flattened());
        }
    }
    kind.content = *hash.finalize().as_bytes();
    let emits = |material: &ModelMaterial| material.emission_factor.iter().any(|factor| *factor > 0.0);
    let is_there = |texture: &TextureRef| model.mesh.set(texture.uv_set).is_some();
    let mut normals = model.materials.iter().filter_map(|material| material.normal.as_ref());
    if normals.any(is_there) {
        kind.outputs[0].channels.push(Channel::Slope);
    }
    if model.materials.iter().any(emits) {
        kind.outputs[0].channels.push(Channel::Emission);
    }
    kind.outputs[0].channels.extend(model_finish::channels(model));
    kind
}

/// Lists the triangles without a UV set that other triangles have, in ascending order.
fn missing(model: &Model, set: u32) -> Vec<Range<u32>> {
    let of_set = model.mesh.missing_uvs.iter().filter(|missing| missing.set == set);
    of_set.map(|missing| missing.triangles.clone()).collect()
}

/// Opens the pictures that the materials use. Adds what cannot be shown to `warnings`.
fn open_materials<'a>(
    model: &'a Model,
    pictures: &SessionPictures,
    memory_bytes: u64,
    size: u32,
    warnings: &mut Vec<String>,
) -> Vec<MaterialTextures<'a>> {
    let decoded = open_pictures(model, pictures, memory_bytes);
    let is_used = |triangles: &Range<u32>, material: usize| {
        let own = model
            .mesh
            .triangle_material
            .get(triangles.start as usize..triangles.end as usize);
        own.is_some_and(|own| own.contains(&(material as u32)))
    };
    let mut open = |material: usize, texture: &Option<TextureRef>, what: &str, reading: PixelReading| {
        let texture = texture.as_ref()?;
        let image = model.images.get(texture.image)?;
        let (name, set) = (&image.name, texture.uv_set);
        if model.mesh.set(set).is_none() {
            warnings.push(format!(
                "the {what} picture {name} is laid out by UV set {set}, which the model does not have; the factor is \
                 used \
                 alone"
            ));
            return None;
        }
        let missing = missing(model, set);
        if missing.iter().any(|triangles| is_used(triangles, material)) {
            warnings.push(format!(
                "the {what} picture {name} is laid out by UV set {set}, which some triangles of its material do not \
                 have; \
                 there the factor is used alone"
            ));
        }
        let picture = decoded
            .get(&texture.image)?
            .as_ref()
            .map_err(|why| warnings.push(why.clone()))
            .ok()?;
        for remark in &picture.picture.remarks.values {
            let remark = format!("the {what} picture {name} {remark}");
            if !warnings.contains(&remark) {
                warnings.push(remark);
            }
        }
        let other = model.mesh.texture_uvs.iter().find(|other| other.set == set);
        let mut texture = ModelTexture::new(name, picture, texture, other, reading, size);
        texture.missing = missing;
        Some(texture)
    };
    // If a material ignores alpha, colors of transparent pixels are visible like others.
    let opaque = |material: &ModelMaterial| PixelReading {
        by_alpha: !material.ignores_alpha,
        ..COLORS
    };
    let open_material = |(index, material): (usize, &'a ModelMaterial)| MaterialTextures {
        material,
        base_color: open(index, &material.base_color, "base color", opaque(material)),
        metallic_roughness: open(index, &material.metallic_roughness, "roughness", VALUES),
        roughness: open(index, &material.roughness, "roughness", VALUES),
        metallic: open(index, &material.metallic, "metallic", VALUES),
        normal: open(index, &material.normal, "normal", VALUES),
        occlusion: open(index, &material.occlusion, "occlusion", VALUES),
        emission: open(index, &material.emission, "emission", COLORS),
        finish: FinishTextures::new(&material.finish, &mut |texture, what, is_srgb| {
            open(index, texture, what, if is_srgb { COLORS } else { VALUES })
        }),
    };
    model.materials.iter().enumerate().map(open_material).collect()
}

/// Provider of the model's textures on the atlas.
#[derive(Default)]
pub(crate) struct ModelSource<'a> {
    /// Textures. They are opened on first use, since cached results need none.
    materials: Option<Vec<MaterialTextures<'a>>>,
    /// Tiles with triangles of each material; `None` if there is only one.
    tiles: Option<Vec<TileSet>>,
    coordinates: CoordinateTables,
}

impl<'a> ModelSource<'a> {
    /// Opens the pictures of the materials, once; they may take `memory_bytes`. Adds what cannot be shown to `warnings`.
    pub(crate) fn open(
        &mut self,
        surface: &SourceSurface<'a>,
        pictures: &SessionPictures,
        memory_bytes: u64,
        warnings: &mut Vec<String>,
    ) {
        let open = || open_materials(surface.model, pictures, memory_bytes, surface.atlas.size, warnings);
        self.materials.get_or_insert_with(open);
    }

    /// Draws a plane of a result of a model, whose pictures were opened. Adds what cannot be shown to `warnings`.
    ///
    /// # Errors
    /// The run is canceled, or the device refuses.
    pub(crate) fn draw(
        &mut self,
        surface: &SourceSurface<'a>,
        canvas: &SourceCanvas<'_>,
        output: &str,
        plane: Plane,
        warnings: &mut Vec<String>,
    ) -> Result<(), GpuError> {
        let materials = self.materials.as_deref().unwrap_or_default();
        let tiles = &*self.tiles.get_or_insert_with(|| surface.tiles_of_materials());
        let unused = &canvas.table("no texture", &[[0; 4]])?;
        for material in 0..tiles.len().max(1) {
            let mut canvas = MaterialCanvas {
                canvas,
                surface,
                material: material as u32,
                tiles: tiles.get(material),
                coordinates: &mut self.coordinates,
                unused,
                warnings,
            };
            match materials.get(material) {
                Some(look) => look.draw(&mut canvas, output, plane)?,
                None => canvas.products([Product::constant(0.0); 4])?,
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
