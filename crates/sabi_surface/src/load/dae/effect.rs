//! Materials, and the effects that describe them.

use std::borrow::Cow;
use std::collections::BTreeMap;

use roxmltree::Node;
use sabi_files::Uri;

use super::document::{DaeDocument, child, children, numbers, text};
use super::geometry::Geometry;
use super::scene::DaeMeshInstance;
use crate::load::faces::NONE;
use crate::load::material_images::{ImageLocation, MaterialImages, file_name, places};
use crate::load::opacity::{set_opacity, set_opacity_map};
use crate::load::value_range::within;
use crate::load::warnings::Warnings;
use crate::model::{ModelMaterial, TextureRef};

/// Materials of the file, and how the instances use them.
pub(super) struct DaeMaterials<'d, 'r> {
    document: &'r DaeDocument<'d>,
    /// Materials in the file's order.
    materials: Vec<Node<'d, 'd>>,
    by_id: BTreeMap<&'d str, u32>,
    /// UV set of a material's textures, by the name that the material uses for the set, according to the first instance.
    sets: BTreeMap<(u32, &'d str), u32>,
}

impl<'d, 'r> DaeMaterials<'d, 'r> {
    pub(super) fn new(document: &'r DaeDocument<'d>) -> DaeMaterials<'d, 'r> {
        let libraries = children(document.root, "library_materials");
        let materials: Vec<Node> = libraries.flat_map(|library| children(library, "material")).collect();
        let ids = materials.iter().map(|material| material.attribute("id")).zip(0..);
        DaeMaterials {
            document,
            by_id: ids.filter_map(|(id, number)| Some((id?, number))).collect(),
            materials,
            sets: BTreeMap::new(),
        }
    }

    /// Returns the material of the file for each symbol of a geometry, and records the UV sets that the instance assigns to
    /// their textures.
    pub(super) fn bound(&mut self, shown: &DaeMeshInstance<'d>, geometry: &Geometry<'d>) -> Vec<u32> {
        let techniques = child(shown.instance, "bind_material").and_then(|bound| child(bound, "technique_common"));
        let bindings = techniques
            .into_iter()
            .flat_map(|bound| children(bound, "instance_material"));
        let mut by_symbol = BTreeMap::new();
        for binding in bindings {
            let target = binding.attribute("target").unwrap_or_default();
            let material = target.strip_prefix('#').and_then(|id| self.by_id.get(id)).copied();
            if material.is_none() {
                self.document.note_missing(binding, target);
            }
            let (Some(symbol), Some(material)) = (binding.attribute("symbol"), material) else {
                continue;
            };
            by_symbol.entry(symbol).or_insert(material);
            for input in children(binding, "bind_vertex_input") {
                let set = input.attribute("input_set").and_then(|set| set.parse().ok());
                // Without a number, the first set is used.
                let set = set.map_or(Some(0), |set| geometry.uv_set(set));
                if let (Some(semantic), Some(set)) = (input.attribute("semantic"), set) {
                    self.sets.entry((material, semantic)).or_insert(set);
                }
            }
        }
        let material = |symbol: &&str| {
            let bound = by_symbol.get(symbol).copied();
            // Some programs write the id of the material instead of a symbol.
            bound.or_else(|| self.by_id.get(symbol).copied()).unwrap_or(NONE)
        };
        geometry.symbols.iter().map(material).collect()
    }

    /// Reads all materials, in the file's order.
    pub(super) fn materials(&self, pictures: &mut MaterialImages, warnings: &mut Warnings) -> Vec<ModelMaterial> {
        let materials = self.materials.iter().zip(0..);
        let read = materials.map(|(node, number)| {
            let name = node.attribute("name").filter(|name| !name.is_empty());
            // A material without name and id is unnamed.
            let name = name.or(node.attribute("id")).unwrap_or_default().to_string();
            let effect = child(*node, "instance_effect");
            let effect = effect.and_then(|effect| self.document.referenced(effect, "url"));
            let profile = effect.and_then(|effect| child(effect, "profile_COMMON"));
            let plain = ModelMaterial {
                name,
                ..ModelMaterial::plain()
            };
            let Some(profile) = profile else { return plain };
            let mut effect = Effect {
                looks: self,
                number,
                profile,
                label: format!("material `{}`", plain.name),
                pictures,
                warnings,
            };
            effect.material(plain)
        });
        read.collect()
    }
}

/// Reader of the effect of one material.
struct Effect<'e, 'd> {
    looks: &'e DaeMaterials<'d, 'e>,
    number: u32,
    profile: Node<'d, 'd>,
    label: String,
    pictures: &'e mut MaterialImages,
    warnings: &'e mut Warnings,
}

impl<'d> Effect<'_, 'd> {
    fn material(&mut self, mut material: ModelMaterial) -> ModelMaterial {
        let Some(technique) = child(self.profile, "technique") else {
            return material;
        };
        let models = ["phong", "blinn", "lambert", "constant"];
        if let Some(model) = models.into_iter().find_map(|model| child(technique, model)) {
            // An unlit material has only its color, as emission.
            let diffuse = child(model, "diffuse");
            material.base_color = diffuse.and_then(|diffuse| self.texture(diffuse, "base color"));
            if material.base_color.is_some() {
                material.base_color_factor = [1.0; 4];
            } else if let Some([r, g, b, _]) = diffuse.and_then(|diffuse| self.color(diffuse)) {
                let whose = format!("The base color of {}", self.label);
                let [r, g, b] = [r, g, b].map(|share| within(share, 1.0, &whose, self.warnings));
                material.base_color_factor = [r, g, b, 1.0];
            }
            let emission = child(model, "emission");
            material.emission = emission.and_then(|emission| self.texture(emission, "emission"));
            if material.emission.is_some() {
                material.emission_factor = [1.0; 3];
            } else if let Some([r, g, b, _]) = emission.and_then(|emission| self.color(emission)) {
                let whose = format!("The emission of {}", self.label);
                material.emission_factor = [r, g, b].map(|share| within(share, f32::MAX, &whose, self.warnings));
            }
            self.read_opacity(model, &mut material);
        }
        self.read_extras(technique, &mut material);
        material
    }

    /// Reads the opacity, which is the alpha of a color (`A_ONE`) or follows from its luminance as transparency
    /// (`RGB_ZERO`); COLLADA 1.4, 7.3.
    fn read_opacity(&mut self, model: Node<'d, 'd>, material: &mut ModelMaterial) {
        let transparent = child(model, "transparent");
        let amount = child(model, "transparency").and_then(|amount| child(amount, "float"));
        let amount = amount.and_then(|amount| numbers(amount, self.warnings).first().copied());
        let amount = amount.filter(|amount| amount.is_finite()).unwrap_or(1.0) as f32;
        if let Some(texture) = transparent.and_then(|transparent| self.texture(transparent, "opacity")) {
            return set_opacity_map(material, texture.image, self.warnings);
        }
        let [r, g, b, a] = transparent
            .and_then(|transparent| self.color(transparent))
            .unwrap_or([1.0; 4]);
        let luminance = 0.2126 * r + 0.7152 * g + 0.0722 * b;
        let opacity = match transparent.and_then(|transparent| transparent.attribute("opaque")) {
            Some("RGB_ZERO") => 1.0 - luminance * amount,
            Some("A_ZERO") => 1.0 - a * amount,
            Some("RGB_ONE") => luminance * amount,
            _ => a * amount,
        };
        set_opacity(material, opacity, self.warnings);
    }

    /// Reads common extensions: a normal map, and whether both sides are visible.
    fn read_extras(&mut self, technique: Node<'d, 'd>, material: &mut ModelMaterial) {
        let extras = children(technique, "extra").chain(children(self.profile, "extra"));
        let extras: Vec<Node> = extras.flat_map(|extra| children(extra, "technique")).collect();
        for extra in extras {
            if let Some(bump) = child(extra, "bump") {
                if bump.attribute("bumptype") == Some("NORMALMAP") {
                    material.normal = self.texture(bump, "normal map");
                } else {
                    self.warnings.add(format!(
                        "The bump map of {} is left out: it is a height, not a normal map.",
                        self.label
                    ));
                }
            }
            if let Some(sides) = child(extra, "double_sided") {
                material.is_double_sided = text(sides) != "0";
            }
        }
    }

    /// Returns a color from four finite numbers, or from three for an opaque color.
    fn color(&mut self, of: Node<'d, 'd>) -> Option<[f32; 4]> {
        let numbers = numbers(child(of, "color")?, self.warnings);
        match numbers[..] {
            [r, g, b] | [r, g, b, _] if [r, g, b].iter().all(|share| share.is_finite()) => {
                let alpha = numbers.get(3).copied().filter(|alpha| alpha.is_finite());
                Some([r, g, b, alpha.unwrap_or(1.0)].map(|share| share as f32))
            }
            _ => {
                self.warnings.add(format!(
                    "The {} of {} is no color of three or four numbers and is left out.",
                    of.tag_name().name(),
                    self.label
                ));
                None
            }
        }
    }

    fn texture(&mut self, of: Node<'d, 'd>, what: &str) -> Option<TextureRef> {
        let texture = child(of, "texture")?;
        let sampler = texture.attribute("texture")?;
        let Some(image) = self.image(sampler) else {
            self.warnings.add(format!(
                "The {what} of {} names a picture that is not there.",
                self.label
            ));
            return None;
        };
        let path = path(image);
        let id = image.attribute("id").unwrap_or(&path);
        let number = self.pictures.number(id, || place(&path));
        // Textures without a name for their set use the first one.
        let set = texture
            .attribute("texcoord")
            .and_then(|name| self.looks.sets.get(&(self.number, name)));
        Some(TextureRef {
            uv_set: set.copied().unwrap_or(0),
            ..TextureRef::of(number)
        })
    }

    /// Returns the image of a sampler, which refers to it by its surface in version 1.4, or directly in 1.5; some files
    /// name the image itself.
    fn image(&self, sampler: &str) -> Option<Node<'d, 'd>> {
        let document = self.looks.document;
        let parameter =
            |name: &str| children(self.profile, "newparam").find(|param| param.attribute("sid") == Some(name));
        let inside = parameter(sampler).and_then(|param| child(param, "sampler2D"));
        let through = inside.and_then(|inside| {
            if let Some(image) = child(inside, "instance_image") {
                return document.referenced(image, "url");
            }
            let surface = parameter(&text(child(inside, "source")?))?;
            document.by_id(&text(child(child(surface, "surface")?, "init_from")?))
        });
        let image = through.or_else(|| document.by_id(sampler));
        image.filter(|image| image.tag_name().name() == "image")
    }
}

/// Returns the path of an image, which is a text in version 1.4 and an element in 1.5.
fn path<'d>(image: Node<'d, 'd>) -> Cow<'d, str> {
    let from = child(image, "init_from");
    let inner = from.and_then(|from| child(from, "ref")).or(from);
    inner.map(text).unwrap_or_default()
}

fn place(path: &str) -> (String, ImageLocation) {
    match Uri::parse(path) {
        Uri::Data(bytes) => ("a picture in the file".to_string(), ImageLocation::Inside(bytes.into())),
        Uri::Beside(decoded) => (
            file_name(&decoded),
            ImageLocation::Beside(places(&[&decoded, path], &[])),
        ),
        // Absolute paths are written with a URI scheme.
        Uri::Damaged(_) | Uri::Unusable(_) => (file_name(path), ImageLocation::Beside(places(&[path], &[]))),
    }
}
