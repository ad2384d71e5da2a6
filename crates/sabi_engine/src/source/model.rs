//! `source/model`: the model's own textures and factors, brought onto the atlas.

use half::f16;
use rayon::prelude::*;
use sabi_graph::PortType;
use sabi_nodes::kind::Channel;
use sabi_nodes::link::{Format, Plane};
use sabi_plan::{SourceKind, SourcePort, SourceStep};
use sabi_surface::atlas::{Atlas, EMPTY, GHOST_BIT};
use sabi_surface::model::{Model, ModelMaterial, TextureRef};

use sabi_gpu::{SourceFill, SurfaceTables};

use super::sampler::Sampler;

/// Id of the kind.
const NAME: &str = "source/model";

/// The kind; without a model its material sets color and surface only.
pub(crate) fn kind() -> SourceKind {
    let port = |name: &str, ty, doc: &str, channels: &[Channel]| SourcePort {
        name: name.to_owned(),
        ty,
        doc: doc.to_owned(),
        channels: channels.to_vec(),
    };
    SourceKind {
        id: NAME.to_owned(),
        label: "Model".to_owned(),
        summary: "The model's own textures and factors, normal map included.".to_owned(),
        params: Vec::new(),
        inputs: Vec::new(),
        outputs: vec![
            port(
                "material",
                PortType::Material,
                "All of it.",
                &[Channel::Color, Channel::Surface],
            ),
            port("base_color", PortType::Color, "Base color.", &[]),
            port("alpha", PortType::Mask, "Opacity.", &[]),
            port("roughness", PortType::Mask, "Roughness.", &[]),
            port("metallic", PortType::Mask, "Metallic.", &[]),
            port("occlusion", PortType::Mask, "Occlusion: 1 is open.", &[]),
            port(
                "slope",
                PortType::Vector,
                "The normal map as a surface gradient in model space.",
                &[],
            ),
            port("emission", PortType::Color, "Emission.", &[]),
        ],
        content: [0; 32],
    }
}

/// The samplers of one material; a picture is decoded when it is first asked for.
struct MaterialSamplers<'a> {
    material: &'a ModelMaterial,
    base_color: Option<Sampler>,
    metallic_roughness: Option<Sampler>,
    normal: Option<Sampler>,
    occlusion: Option<Sampler>,
    emission: Option<Sampler>,
}

/// Linear RGBA of a picture; white where there is none.
fn sample(sampler: &Option<Sampler>, uv: [f64; 2]) -> [f32; 4] {
    sampler.as_ref().map_or([1.0; 4], |sampler| sampler.sample(uv))
}

impl MaterialSamplers<'_> {
    fn base_color(&self, uv: [f64; 2]) -> [f32; 4] {
        let color = sample(&self.base_color, uv);
        std::array::from_fn(|at| color[at] * self.material.base_color_factor[at])
    }

    /// Roughness, metallic, occlusion.
    fn surface(&self, uv: [f64; 2]) -> [f32; 3] {
        let [_, rough, metal, _] = sample(&self.metallic_roughness, uv);
        let [open, ..] = sample(&self.occlusion, uv);
        let material = self.material;
        [
            rough * material.roughness_factor,
            metal * material.metallic_factor,
            1.0 + material.occlusion_strength * (open - 1.0),
        ]
    }

    fn emission(&self, uv: [f64; 2]) -> [f32; 3] {
        let emission = sample(&self.emission, uv);
        std::array::from_fn(|at| emission[at] * self.material.emission_factor[at])
    }

    /// The normal in tangent space, not of unit length.
    fn normal(&self, uv: [f64; 2]) -> [f32; 3] {
        let Some(sampler) = &self.normal else {
            return [0.0, 0.0, 1.0];
        };
        let [x, y, z, _] = sampler.sample(uv).map(|code| 2.0 * code - 1.0);
        [x * self.material.normal_scale, y * self.material.normal_scale, z]
    }
}

/// The model's textures on the atlas.
pub(crate) struct ModelSource<'a> {
    model: &'a Model,
    atlas: &'a Atlas,
    tables: &'a SurfaceTables,
    /// Decoded at the first use: a run whose results are cached needs none of it.
    materials: Option<Vec<MaterialSamplers<'a>>>,
    /// What cannot be shown, as sentences.
    pub(crate) warnings: Vec<String>,
}

/// The kind for a model: which channels its material sets, and a hash of all that it shows.
pub(crate) fn kind_for(model: &Model) -> SourceKind {
    let mut kind = kind();
    let mut hash = blake3::Hasher::new();
    for image in &model.images {
        match &image.bytes {
            Ok(bytes) => hash.update(blake3::hash(bytes).as_bytes()),
            Err(why) => hash.update(why.as_bytes()),
        };
    }
    hash.update(format!("{:?}", model.materials).as_bytes());
    kind.content = *hash.finalize().as_bytes();
    let emits = |material: &ModelMaterial| material.emission_factor.iter().any(|factor| *factor > 0.0);
    if model
        .materials
        .iter()
        .any(|material| usable(&material.normal).is_some())
    {
        kind.outputs[0].channels.push(Channel::Slope);
    }
    if model.materials.iter().any(emits) {
        kind.outputs[0].channels.push(Channel::Emission);
    }
    kind
}

/// A texture that is meant for the UV set at hand.
fn usable(texture: &Option<TextureRef>) -> Option<&TextureRef> {
    texture.as_ref().filter(|texture| texture.on_loaded_uv_set)
}

/// Decodes the pictures that the materials use. What cannot be shown is added to `warnings`.
fn open_materials<'a>(model: &'a Model, size: u32, warnings: &mut Vec<String>) -> Vec<MaterialSamplers<'a>> {
    let mut open = |texture: &Option<TextureRef>, what: &str, is_srgb: bool| {
        let texture = texture.as_ref()?;
        let image = model.images.get(texture.image)?;
        if !texture.on_loaded_uv_set {
            let name = &image.name;
            warnings.push(format!(
                "the {what} picture {name} uses another UV set and is left out; see --uv"
            ));
            return None;
        }
        let bytes = image.bytes.as_ref().map_err(|why| warnings.push(why.clone())).ok()?;
        let decoded = sabi_image::decode(&image.name, bytes);
        let told = decoded.map_err(|why| warnings.push(format!("{why}; the factor is used alone")));
        Some(Sampler::new(told.ok()?, texture, is_srgb, size))
    };
    let open_material = |material: &'a ModelMaterial| MaterialSamplers {
        material,
        base_color: open(&material.base_color, "base color", true),
        metallic_roughness: open(&material.metallic_roughness, "roughness", false),
        normal: open(&material.normal, "normal", false),
        occlusion: open(&material.occlusion, "occlusion", false),
        emission: open(&material.emission, "emission", true),
    };
    model.materials.iter().map(open_material).collect()
}

/// A point of the surface: its triangle, and where it lies on its chart's page.
struct Spot {
    triangle: usize,
    texel: [f64; 2],
    uv: [f64; 2],
}

impl<'a> ModelSource<'a> {
    /// A source that has not decoded anything yet.
    pub(crate) fn new(model: &'a Model, atlas: &'a Atlas, tables: &'a SurfaceTables) -> ModelSource<'a> {
        ModelSource {
            model,
            atlas,
            tables,
            materials: None,
            warnings: Vec::new(),
        }
    }

    /// The surface point under a texel; over the seam for a ghost.
    fn spot(&self, index: usize) -> Option<Spot> {
        let owner = self.atlas.owners[index];
        if owner == EMPTY {
            return None;
        }
        let [width, height] = self.atlas.page_size.map(|side| side as usize);
        let (triangle, texel) = if owner & GHOST_BIT != 0 {
            let ghost = self.atlas.ghosts.get((owner & !GHOST_BIT) as usize)?;
            (ghost.target_triangle as usize, ghost.target_texel.map(f64::from))
        } else {
            (
                owner as usize,
                [(index % width) as f64 + 0.5, ((index / width) % height) as f64 + 0.5],
            )
        };
        let chart = &self.atlas.charts[self.atlas.triangle_chart[triangle] as usize];
        let size = f64::from(self.atlas.size);
        let uv = std::array::from_fn(|axis| (texel[axis] - f64::from(chart.texel_from_uv[axis])) / size);
        Some(Spot { triangle, texel, uv })
    }

    /// What a plane of a result holds at a point.
    fn value(&self, output: &str, plane: Plane, spot: &Spot) -> Option<[f32; 4]> {
        let material = self.model.mesh.triangle_material[spot.triangle] as usize;
        let look = self.materials.as_ref()?.get(material)?;
        let uv = spot.uv;
        let triple = |[x, y, z]: [f32; 3]| [x, y, z, 1.0];
        Some(match (plane, output) {
            (Plane::Material(Channel::Color), _) => look.base_color(uv),
            (Plane::Material(Channel::Surface), _) => triple(look.surface(uv)),
            (Plane::Material(Channel::Height), _) => [0.0; 4],
            (Plane::Material(Channel::Slope), _) | (Plane::Vector, _) => {
                triple(slope(self.tables, spot.triangle, spot.texel, look.normal(uv)))
            }
            (Plane::Material(Channel::Emission), _) | (Plane::Color, "emission") => triple(look.emission(uv)),
            (Plane::Color, _) => {
                let [r, g, b, _] = look.base_color(uv);
                [r, g, b, 1.0]
            }
            (Plane::Mask, "alpha") => [look.base_color(uv)[3], 0.0, 0.0, 1.0],
            (Plane::Mask, "roughness") => [look.surface(uv)[0], 0.0, 0.0, 1.0],
            (Plane::Mask, "metallic") => [look.surface(uv)[1], 0.0, 0.0, 1.0],
            (Plane::Mask, _) => [look.surface(uv)[2], 0.0, 0.0, 1.0],
        })
    }

    fn texels(&self, output: &str, plane: Plane) -> Vec<u8> {
        let format = plane.format();
        let size = format.texel_bytes() as usize;
        let mut bytes = vec![0_u8; self.atlas.owners.len() * size];
        let chunk = 4096;
        bytes.par_chunks_mut(chunk * size).enumerate().for_each(|(at, texels)| {
            for (offset, texel) in texels.chunks_exact_mut(size).enumerate() {
                let spot = self.spot(at * chunk + offset);
                if let Some(value) = spot.and_then(|spot| self.value(output, plane, &spot)) {
                    put(texel, format, value);
                }
            }
        });
        bytes
    }
}

/// The surface gradient that a tangent-space normal stands for: `up − n / (n · up)` with `n` in model space.
fn slope(tables: &SurfaceTables, triangle: usize, texel: [f64; 2], normal: [f32; 3]) -> [f32; 3] {
    if normal[0] == 0.0 && normal[1] == 0.0 {
        return [0.0; 3];
    }
    let geometry = &tables.geometry[6 * triangle..];
    let frames = &tables.frames[4 * triangle..];
    let step = [
        texel[0] - f64::from(geometry[0][3]),
        texel[1] - f64::from(geometry[1][3]),
    ];
    let affine = |rows: [&[f32; 4]; 3]| -> [f64; 3] {
        std::array::from_fn(|axis| {
            f64::from(rows[0][axis]) + f64::from(rows[1][axis]) * step[0] + f64::from(rows[2][axis]) * step[1]
        })
    };
    let n = affine([&geometry[3], &geometry[4], &geometry[5]]);
    let t = affine([&frames[0], &frames[1], &frames[2]]);
    let sign = f64::from(frames[0][3]);
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [
            a[1] * b[2] - a[2] * b[1],
            a[2] * b[0] - a[0] * b[2],
            a[0] * b[1] - a[1] * b[0],
        ]
    };
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let b = cross(n, t).map(|x| sign * x);
    let [x, y, z] = normal.map(f64::from);
    let tilted: [f64; 3] = std::array::from_fn(|axis| x * t[axis] + y * b[axis] + z * n[axis]);
    let length = dot(n, n).sqrt();
    let up = n.map(|axis| axis / length.max(1e-30));
    let along = dot(tilted, up);
    // A normal that leans back below the surface has no slope; it is taken as very steep instead.
    let along = along.max(1e-3 * dot(tilted, tilted).sqrt()).max(1e-30);
    std::array::from_fn(|axis| (up[axis] - tilted[axis] / along) as f32)
}

fn put(texel: &mut [u8], format: Format, value: [f32; 4]) {
    match format {
        Format::Rgba16Float => {
            for (bytes, value) in texel.chunks_exact_mut(2).zip(value) {
                bytes.copy_from_slice(&f16::from_f32(value).to_le_bytes());
            }
        }
        Format::R32Float | Format::Rgba32Float => {
            for (bytes, value) in texel.chunks_exact_mut(4).zip(value) {
                bytes.copy_from_slice(&value.to_le_bytes());
            }
        }
    }
}

impl SourceFill for ModelSource<'_> {
    fn plane(&mut self, step: &SourceStep, output: &str, plane: Plane) -> Result<Vec<u8>, String> {
        if step.kind != NAME {
            return Err(format!(
                "node '{}' is of kind '{}', which nobody fills; this is a mistake in Sabi",
                step.id, step.kind
            ));
        }
        if self.materials.is_none() {
            self.materials = Some(open_materials(self.model, self.atlas.size, &mut self.warnings));
        }
        Ok(self.texels(output, plane))
    }
}
