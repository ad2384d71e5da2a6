//! glTF material extensions that describe more than base color, roughness, metallic and emission.

use gltf::json;
use serde_json::Value;

use super::GltfImages;
use crate::load::gltf::document::FINISHES;
use crate::load::gltf::texture_use::{RawUse, members, raw_use};
use crate::model::{ModelFinish, TextureRef, TexturedFactor};

/// Reader of the extensions of one material.
struct FinishReader<'r, 'a, 'm> {
    pictures: &'r mut GltfImages<'a>,
    material: &'m json::Material,
    label: &'r str,
}

impl GltfImages<'_> {
    /// Reads the extensions of a material.
    pub(super) fn finish(&mut self, material: &json::Material, label: &str) -> ModelFinish {
        let mut reader = FinishReader {
            pictures: self,
            material,
            label,
        };
        let [clearcoat, anisotropy, sheen, diffuse_transmission, transmission] = FINISHES;
        ModelFinish {
            coat: reader.scaled(clearcoat, "clearcoatFactor", [0.0], "clearcoatTexture"),
            coat_roughness: reader.scaled(
                clearcoat,
                "clearcoatRoughnessFactor",
                [0.0],
                "clearcoatRoughnessTexture",
            ),
            anisotropy: reader.scaled(anisotropy, "anisotropyStrength", [0.0], "anisotropyTexture"),
            anisotropy_rotation: reader.number(anisotropy, "anisotropyRotation"),
            sheen: reader.scaled(sheen, "sheenColorFactor", [0.0; 3], "sheenColorTexture"),
            sheen_roughness: reader.scaled(sheen, "sheenRoughnessFactor", [0.0], "sheenRoughnessTexture"),
            subsurface: reader.scaled(
                diffuse_transmission,
                "diffuseTransmissionFactor",
                [0.0],
                "diffuseTransmissionTexture",
            ),
            subsurface_color: reader.scaled(
                diffuse_transmission,
                "diffuseTransmissionColorFactor",
                [1.0; 3],
                "diffuseTransmissionColorTexture",
            ),
            transmission: reader.scaled(transmission, "transmissionFactor", [0.0], "transmissionTexture"),
        }
    }
}

impl FinishReader<'_, '_, '_> {
    fn number(&self, extension: &str, key: &str) -> f32 {
        let value = members(self.material, extension).and_then(|members| members.get(key)?.as_f64());
        value.map_or(0.0, |value| value as f32)
    }

    /// Returns a factor between 0 and 1, or its default, with its texture.
    fn scaled<const N: usize, T: From<Factors<N>>>(
        &mut self,
        extension: &str,
        factor: &str,
        default: [f32; N],
        texture: &str,
    ) -> TexturedFactor<T> {
        let members = members(self.material, extension);
        let given = members.and_then(|members| numbers(members.get(factor)?));
        let factors = match (members, given) {
            (Some(_), Some(given)) => self.pictures.within(given, 1.0, factor, self.label),
            (Some(_), None) => default,
            // Without the extension the factor is zero.
            (None, _) => [0.0; N],
        };
        let used = members.and_then(|members| raw_use(members.get(texture)?));
        TexturedFactor {
            factor: Factors(factors).into(),
            texture: used.and_then(|used| self.texture(&used)),
        }
    }

    fn texture(&mut self, used: &RawUse<'_>) -> Option<TextureRef> {
        self.pictures
            .with_raw_transform(self.label, used.texture, used.uv_set, used.extensions)
    }
}

/// Numbers of a factor.
struct Factors<const N: usize>([f32; N]);

impl From<Factors<1>> for f32 {
    fn from(Factors([factor]): Factors<1>) -> f32 {
        factor
    }
}

impl From<Factors<3>> for [f32; 3] {
    fn from(Factors(factors): Factors<3>) -> [f32; 3] {
        factors
    }
}

fn numbers<const N: usize>(value: &Value) -> Option<[f32; N]> {
    let numbers: Vec<f32> = match value {
        Value::Array(values) => values.iter().filter_map(|value| Some(value.as_f64()? as f32)).collect(),
        single => vec![single.as_f64()? as f32],
    };
    numbers.try_into().ok()
}
