//! Treatment of each property of a glTF material that gets maps: the table of docs/model-copy.md, which contains the reasons, as data.

use schemars::JsonSchema;
use serde::Serialize;

/// Treatment of a property.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Treatment {
    /// The copy does not have it.
    Removed,
    /// It is as the model has it.
    Kept,
    /// The copy has it from the graph's material. It is absent if that has glTF's default value.
    Set,
}

/// Object of the file that has a property.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum PropertyOwner {
    Material,
    MetallicRoughness,
    /// The extensions of the material.
    Extensions,
    /// Each primitive of the material.
    Primitive,
    /// Extensions that no other rule names.
    OtherExtensions,
}

/// Treatment of one property.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rule {
    /// Name in the file; a pattern for [`PropertyOwner::OtherExtensions`].
    pub(super) property: &'static str,
    pub(super) owner: PropertyOwner,
    pub(super) treatment: Treatment,
    /// Treatment where the look of the model is kept.
    pub(super) kept_look: Treatment,
}

impl Rule {
    /// The treatment under the options of a copy.
    pub(super) fn treatment(&self, keeps_look: bool) -> Treatment {
        if keeps_look { self.kept_look } else { self.treatment }
    }
}

const fn rule(owner: PropertyOwner, property: &'static str, treatments: [Treatment; 2]) -> Rule {
    let [treatment, kept_look] = treatments;
    Rule {
        property,
        owner,
        treatment,
        kept_look,
    }
}

const SET: [Treatment; 2] = [Treatment::Set; 2];
const KEPT: [Treatment; 2] = [Treatment::Kept; 2];
const REMOVED: [Treatment; 2] = [Treatment::Removed; 2];
const REMOVED_WITH_LOOK: [Treatment; 2] = [Treatment::Removed, Treatment::Kept];

/// All rules, in the order of the documents.
pub(super) const RULES: [Rule; 32] = {
    use PropertyOwner::{Extensions, Material, MetallicRoughness, OtherExtensions, Primitive};
    [
        rule(MetallicRoughness, "baseColorFactor", SET),
        rule(MetallicRoughness, "baseColorTexture", SET),
        rule(MetallicRoughness, "metallicFactor", SET),
        rule(MetallicRoughness, "roughnessFactor", SET),
        rule(MetallicRoughness, "metallicRoughnessTexture", SET),
        rule(Material, "normalTexture", SET),
        rule(Material, "occlusionTexture", SET),
        rule(Material, "emissiveTexture", SET),
        rule(Material, "emissiveFactor", SET),
        rule(Extensions, "KHR_materials_emissive_strength", SET),
        rule(Material, "alphaMode", SET),
        rule(Material, "alphaCutoff", KEPT),
        rule(Material, "doubleSided", KEPT),
        rule(Extensions, "KHR_materials_clearcoat", SET),
        rule(Extensions, "KHR_materials_anisotropy", SET),
        rule(Extensions, "KHR_materials_sheen", SET),
        rule(Extensions, "KHR_materials_diffuse_transmission", SET),
        rule(Extensions, "KHR_materials_transmission", SET),
        rule(Extensions, "KHR_materials_unlit", REMOVED_WITH_LOOK),
        rule(Extensions, "KHR_materials_pbrSpecularGlossiness", REMOVED),
        rule(Extensions, "KHR_materials_volume", REMOVED_WITH_LOOK),
        rule(Extensions, "KHR_materials_ior", REMOVED_WITH_LOOK),
        rule(Extensions, "KHR_materials_specular", REMOVED_WITH_LOOK),
        rule(Extensions, "KHR_materials_iridescence", REMOVED_WITH_LOOK),
        rule(Extensions, "KHR_materials_dispersion", REMOVED_WITH_LOOK),
        rule(OtherExtensions, "*_materials_*", REMOVED_WITH_LOOK),
        rule(OtherExtensions, "MSFT_packing_*", REMOVED_WITH_LOOK),
        rule(OtherExtensions, "others", KEPT),
        rule(Primitive, "KHR_materials_variants", KEPT),
        rule(Primitive, "COLOR_n", REMOVED_WITH_LOOK),
        rule(Primitive, "TANGENT", SET),
        rule(Primitive, "TEXCOORD_n", KEPT),
    ]
};

/// Rule of an extension of a material.
pub(super) fn of_extension(name: &str) -> Option<&'static Rule> {
    let named = RULES
        .iter()
        .find(|rule| rule.owner == PropertyOwner::Extensions && rule.property == name);
    named.or_else(|| {
        let pattern = match name {
            name if name.starts_with("MSFT_packing_") => "MSFT_packing_*",
            name if name.contains("_materials_") => "*_materials_*",
            _ => "others",
        };
        RULES
            .iter()
            .find(|rule| rule.owner == PropertyOwner::OtherExtensions && rule.property == pattern)
    })
}
