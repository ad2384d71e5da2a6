//! `source/model`: the model's own textures and factors, brought onto the atlas.

use sabi_graph::PortType;
use sabi_nodes::kind::Channel;
use sabi_nodes::link::Plane;
use sabi_plan::{SourceKind, SourcePort};
use sabi_surface::model::{Model, ModelMaterial, TextureRef};

use super::sampler::Sampler;
use super::texels::{Ground, Spot};

/// Id of the kind.
pub(crate) const NAME: &str = "source/model";

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
        aliases: ["texture", "original", "mesh"].map(str::to_owned).to_vec(),
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

    /// What a plane of a result holds at a point.
    fn value(&self, ground: &Ground<'_>, output: &str, plane: Plane, spot: &Spot) -> [f32; 4] {
        let uv = spot.uv;
        let triple = |[x, y, z]: [f32; 3]| [x, y, z, 1.0];
        match (plane, output) {
            (Plane::Material(Channel::Color), _) => self.base_color(uv),
            (Plane::Material(Channel::Surface), _) => triple(self.surface(uv)),
            (Plane::Material(Channel::Height), _) => [0.0; 4],
            (Plane::Material(Channel::Slope), _) | (Plane::Vector, _) => {
                triple(ground.frame(spot).slope(self.normal(uv)))
            }
            (Plane::Material(Channel::Emission), _) | (Plane::Color, "emission") => triple(self.emission(uv)),
            (Plane::Color, _) => {
                let [r, g, b, _] = self.base_color(uv);
                [r, g, b, 1.0]
            }
            (Plane::Mask, "alpha") => [self.base_color(uv)[3], 0.0, 0.0, 1.0],
            (Plane::Mask, "roughness") => [self.surface(uv)[0], 0.0, 0.0, 1.0],
            (Plane::Mask, "metallic") => [self.surface(uv)[1], 0.0, 0.0, 1.0],
            (Plane::Mask, _) => [self.surface(uv)[2], 0.0, 0.0, 1.0],
        }
    }
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

/// The model's textures on the atlas.
#[derive(Default)]
pub(crate) struct ModelSource<'a> {
    /// Decoded at the first use: a run whose results are cached needs none of it.
    materials: Option<Vec<MaterialSamplers<'a>>>,
}

impl<'a> ModelSource<'a> {
    /// A plane of a result. What cannot be shown is added to `warnings`.
    pub(crate) fn plane(
        &mut self,
        ground: &Ground<'a>,
        output: &str,
        plane: Plane,
        warnings: &mut Vec<String>,
    ) -> Vec<u8> {
        let open = || open_materials(ground.model, ground.atlas.size, warnings);
        let materials = &*self.materials.get_or_insert_with(open);
        let material_of = &ground.model.mesh.triangle_material;
        ground.texels(plane, |spot| {
            let look = materials.get(material_of[spot.triangle] as usize);
            look.map_or([0.0; 4], |look| look.value(ground, output, plane, spot))
        })
    }
}
