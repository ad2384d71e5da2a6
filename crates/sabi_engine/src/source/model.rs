//! `source/model`: the model's own textures and factors, brought onto the atlas.

use half::f16;
use rayon::prelude::*;
use sabi_graph::PortType;
use sabi_nodes::kind::Channel;
use sabi_nodes::link::{Format, Plane};
use sabi_plan::{SourceKind, SourcePort, SourceStep};
use sabi_surface::atlas::{Atlas, EMPTY, GHOST_BIT};
use sabi_surface::model::{Model, ModelMaterial, TextureRef};

use sabi_gpu::{SourceFill, SourceTexels, SurfaceTables};

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

/// What a material of the model's looks like at a place.
struct Look {
    base_color: [f32; 4],
    roughness: f32,
    metallic: f32,
    occlusion: f32,
    emission: [f32; 3],
    /// Tangent space, not normalized.
    normal: [f32; 3],
}

/// The samplers of one material.
struct MaterialSamplers<'a> {
    material: &'a ModelMaterial,
    base_color: Option<Sampler>,
    metallic_roughness: Option<Sampler>,
    normal: Option<Sampler>,
    occlusion: Option<Sampler>,
    emission: Option<Sampler>,
}

impl MaterialSamplers<'_> {
    fn look(&self, uv: [f64; 2]) -> Look {
        let sample = |sampler: &Option<Sampler>| sampler.as_ref().map_or([1.0; 4], |sampler| sampler.sample(uv));
        let color = sample(&self.base_color);
        let surface = sample(&self.metallic_roughness);
        let emission = sample(&self.emission);
        let material = self.material;
        let normal = match &self.normal {
            None => [0.0, 0.0, 1.0],
            Some(sampler) => {
                let [x, y, z, _] = sampler.sample(uv).map(|code| 2.0 * code - 1.0);
                [x * material.normal_scale, y * material.normal_scale, z]
            }
        };
        Look {
            base_color: std::array::from_fn(|at| color[at] * material.base_color_factor[at]),
            roughness: surface[1] * material.roughness_factor,
            metallic: surface[2] * material.metallic_factor,
            occlusion: 1.0 + material.occlusion_strength * (sample(&self.occlusion)[0] - 1.0),
            emission: std::array::from_fn(|at| emission[at] * material.emission_factor[at]),
            normal,
        }
    }
}

/// The model's textures on the atlas.
pub(crate) struct ModelSource<'a> {
    atlas: &'a Atlas,
    tables: &'a SurfaceTables,
    materials: Vec<MaterialSamplers<'a>>,
    triangle_material: &'a [u32],
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

impl<'a> ModelSource<'a> {
    /// Decodes the pictures that the materials use. What cannot be shown is answered as sentences.
    pub(crate) fn new(model: &'a Model, atlas: &'a Atlas, tables: &'a SurfaceTables) -> (ModelSource<'a>, Vec<String>) {
        let mut warnings = Vec::new();
        let mut open = |texture: &Option<TextureRef>, what: &str, is_srgb: bool| {
            let texture = texture.as_ref()?;
            let image = model.images.get(texture.image)?;
            if !texture.on_loaded_uv_set {
                warnings.push(format!(
                    "the {what} picture {} uses another UV set and is left out; see --uv",
                    image.name
                ));
                return None;
            }
            let bytes = image.bytes.as_ref().map_err(|why| warnings.push(why.clone())).ok()?;
            let decoded = sabi_image::decode(&image.name, bytes);
            let picture = decoded
                .map_err(|why| warnings.push(format!("{why}; the factor is used alone")))
                .ok()?;
            Some(Sampler::new(picture, texture, is_srgb, atlas.size))
        };
        let materials = model
            .materials
            .iter()
            .map(|material| MaterialSamplers {
                material,
                base_color: open(&material.base_color, "base color", true),
                metallic_roughness: open(&material.metallic_roughness, "roughness", false),
                normal: open(&material.normal, "normal", false),
                occlusion: open(&material.occlusion, "occlusion", false),
                emission: open(&material.emission, "emission", true),
            })
            .collect();
        let triangle_material = &model.mesh.triangle_material;
        (
            ModelSource {
                atlas,
                tables,
                materials,
                triangle_material,
            },
            warnings,
        )
    }

    /// The look of the surface point under a texel, and its slope in model space.
    fn at(&self, index: usize) -> Option<(Look, [f32; 3])> {
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
        let look = self.materials.get(self.triangle_material[triangle] as usize)?.look(uv);
        let slope = slope(self.tables, triangle, texel, look.normal);
        Some((look, slope))
    }

    fn plane(&self, output: &str, plane: Plane) -> Vec<u8> {
        let format = plane.format();
        let size = format.texel_bytes() as usize;
        let mut bytes = vec![0_u8; self.atlas.owners.len() * size];
        let chunk = 4096;
        bytes.par_chunks_mut(chunk * size).enumerate().for_each(|(at, texels)| {
            for (offset, texel) in texels.chunks_exact_mut(size).enumerate() {
                if let Some((look, slope)) = self.at(at * chunk + offset) {
                    put(texel, format, channel_value(output, plane, &look, slope));
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

fn channel_value(output: &str, plane: Plane, look: &Look, slope: [f32; 3]) -> [f32; 4] {
    let [r, g, b, a] = look.base_color;
    let [ex, ey, ez] = look.emission;
    let [sx, sy, sz] = slope;
    match (plane, output) {
        (Plane::Material(Channel::Color), _) => [r, g, b, a],
        (Plane::Material(Channel::Surface), _) => [look.roughness, look.metallic, look.occlusion, 1.0],
        (Plane::Material(Channel::Height), _) => [0.0; 4],
        (Plane::Material(Channel::Slope), _) | (Plane::Vector, _) => [sx, sy, sz, 1.0],
        (Plane::Material(Channel::Emission), _) | (Plane::Color, "emission") => [ex, ey, ez, 1.0],
        (Plane::Color, _) => [r, g, b, 1.0],
        (Plane::Mask, "alpha") => [a, 0.0, 0.0, 1.0],
        (Plane::Mask, "roughness") => [look.roughness, 0.0, 0.0, 1.0],
        (Plane::Mask, "metallic") => [look.metallic, 0.0, 0.0, 1.0],
        (Plane::Mask, _) => [look.occlusion, 0.0, 0.0, 1.0],
    }
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
    fn fill(&mut self, step: &SourceStep) -> Result<Vec<SourceTexels>, String> {
        if step.kind != NAME {
            return Err(format!(
                "node '{}' is of kind '{}', which nobody fills; this is a mistake in Sabi",
                step.id, step.kind
            ));
        }
        let planes = step
            .writes
            .iter()
            .flat_map(|(output, planes)| planes.iter().map(move |(plane, _)| (output, *plane)));
        let texels = planes.map(|(output, plane)| SourceTexels {
            output: output.clone(),
            plane,
            bytes: self.plane(output, plane),
        });
        Ok(texels.collect())
    }
}
