//! Rare properties of a material, as glTF material extensions.

use serde_json::{Map, Value as Json};

use super::finish_maps::{FinishMaps, MappedFactor};
use super::map_file::MapFile;
use super::numbers::{numbers, short};

/// The extensions that [`FinishMaps::extensions`] writes.
pub(super) const EXTENSIONS: [&str; 5] = [
    "KHR_materials_clearcoat",
    "KHR_materials_anisotropy",
    "KHR_materials_sheen",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_transmission",
];

impl FinishMaps {
    /// Returns the extensions for these properties. `place` adds a texture and returns its use; `normal` is the use of the
    /// normal map. Properties that are zero are omitted.
    pub(super) fn extensions(self, place: &mut dyn FnMut(MapFile) -> Json, normal: Option<&Json>) -> Map<String, Json> {
        let [clearcoat, anisotropy, sheen, diffuse_transmission, transmission] = EXTENSIONS;
        let mut extensions = Map::new();
        let mut put = |name: &str, entries: Vec<(&str, Option<Json>)>| {
            let entries = entries
                .into_iter()
                .filter_map(|(key, value)| Some((key.to_owned(), value?)));
            extensions.insert(name.to_owned(), Json::Object(entries.collect()));
        };
        if self.coat.factor > 0.0 {
            put(
                clearcoat,
                clearcoat_entries(self.coat, self.coat_roughness, place, normal),
            );
        }
        if self.anisotropy.factor > 0.0 {
            let rotation = (self.anisotropy_rotation != 0.0).then(|| short(self.anisotropy_rotation));
            let texture = self.anisotropy.map.map(&mut *place);
            let strength = Some(short(self.anisotropy.factor));
            put(
                anisotropy,
                vec![
                    ("anisotropyStrength", strength),
                    ("anisotropyRotation", rotation),
                    ("anisotropyTexture", texture),
                ],
            );
        }
        if self.sheen.factor != [0.0; 3] {
            put(sheen, sheen_entries(self.sheen, self.sheen_roughness, place));
        }
        if self.subsurface.factor != [0.0; 3] {
            put(diffuse_transmission, subsurface_entries(self.subsurface, place));
        }
        if self.transmission.factor > 0.0 {
            let factor = Some(short(self.transmission.factor));
            let texture = self.transmission.map.map(&mut *place);
            put(
                transmission,
                vec![("transmissionFactor", factor), ("transmissionTexture", texture)],
            );
        }
        extensions
    }
}

type Entries = Vec<(&'static str, Option<Json>)>;

fn clearcoat_entries(
    coat: MappedFactor<f32>,
    roughness: f32,
    place: &mut dyn FnMut(MapFile) -> Json,
    normal: Option<&Json>,
) -> Entries {
    let texture = coat.map.map(place);
    vec![
        ("clearcoatFactor", Some(short(coat.factor))),
        ("clearcoatTexture", texture.clone()),
        ("clearcoatRoughnessFactor", Some(short(roughness))),
        ("clearcoatRoughnessTexture", texture),
        // The coat follows the relief, as in Sabi.
        ("clearcoatNormalTexture", normal.cloned()),
    ]
}

fn sheen_entries(sheen: MappedFactor<[f32; 3]>, roughness: f32, place: &mut dyn FnMut(MapFile) -> Json) -> Entries {
    let texture = sheen.map.map(place);
    vec![
        ("sheenColorFactor", Some(numbers(&sheen.factor))),
        ("sheenColorTexture", texture.clone()),
        ("sheenRoughnessFactor", Some(short(roughness))),
        ("sheenRoughnessTexture", texture),
    ]
}

fn subsurface_entries(subsurface: MappedFactor<[f32; 3]>, place: &mut dyn FnMut(MapFile) -> Json) -> Entries {
    // The largest of the three components is the share, and the color is divided by it.
    let share = subsurface.factor.into_iter().fold(0.0, f32::max);
    let color = subsurface.factor.map(|part| part / share);
    vec![
        ("diffuseTransmissionFactor", Some(short(share))),
        ("diffuseTransmissionColorFactor", Some(numbers(&color))),
        ("diffuseTransmissionColorTexture", subsurface.map.map(place)),
    ]
}
