//! The inputs of both shaders.

use super::super::material::{ChannelSource, DocumentMaterial};
use super::super::numbers::list;
use super::super::xml::XmlElement;
use super::graph::{MaterialXGraph, MaterialXNode, NodeArgument, constant};
use crate::{Channel, ConstantValue};

/// Mean free path below the surface, in units of the scene. A material only has a color for subsurface light, not a length.
const SUBSURFACE_RADIUS: f32 = 0.01;
/// Least divisor of a color.
const LEAST: f32 = 1e-6;

/// A shader with its inputs.
pub(super) struct Shader {
    pub(super) node: &'static str,
    pub(super) inputs: Vec<XmlElement>,
}

/// Returns the shader of glTF's materials. It does not support subsurface light.
pub(super) fn gltf(material: &DocumentMaterial, graph: &mut MaterialXGraph<'_>) -> Shader {
    let same = [
        ("base_color", Channel::BaseColor),
        ("metallic", Channel::Metallic),
        ("roughness", Channel::Roughness),
        ("occlusion", Channel::Occlusion),
        ("normal", Channel::Normal),
        ("alpha", Channel::Opacity),
        ("emissive", Channel::Emission),
        ("clearcoat", Channel::Coat),
        ("clearcoat_roughness", Channel::CoatRoughness),
        ("sheen_color", Channel::Sheen),
        ("sheen_roughness", Channel::SheenRoughness),
        ("transmission", Channel::Transmission),
    ];
    let mut inputs: Vec<XmlElement> = same
        .iter()
        .filter_map(|(input, channel)| graph.input(input, channel))
        .collect();
    if has(material, &Channel::Opacity) {
        // OPAQUE, MASK, BLEND.
        inputs.push(constant("alpha_mode", "integer", "2"));
    }
    if has(material, &Channel::Coat) {
        inputs.extend(graph.input("clearcoat_normal", &Channel::Normal));
    }
    match material.channels.get(&Channel::Anisotropy) {
        Some(ChannelSource::Value(value)) => {
            inputs.push(constant("anisotropy_strength", "float", list(&[value.component(2)])));
            inputs.push(constant("anisotropy_rotation", "float", list(&[rotation(*value)])));
        }
        Some(_) => {
            if let Some([strength, rotation]) = anisotropy(graph) {
                inputs.push(graph.output("anisotropy_strength", "anisotropy_strength", &strength));
                inputs.push(graph.output("anisotropy_rotation", "anisotropy_rotation", &rotation));
            }
        }
        None => {}
    }
    Shader {
        node: "gltf_pbr",
        inputs,
    }
}

/// Returns the OpenPBR shader. It does not support occlusion.
pub(super) fn open_pbr(material: &DocumentMaterial, graph: &mut MaterialXGraph<'_>) -> Shader {
    let same = [
        ("base_color", Channel::BaseColor),
        ("base_metalness", Channel::Metallic),
        ("specular_roughness", Channel::Roughness),
        ("geometry_normal", Channel::Normal),
        ("geometry_opacity", Channel::Opacity),
        ("emission_color", Channel::Emission),
        ("coat_weight", Channel::Coat),
        ("coat_roughness", Channel::CoatRoughness),
        ("fuzz_roughness", Channel::SheenRoughness),
        ("transmission_weight", Channel::Transmission),
    ];
    let mut inputs: Vec<XmlElement> = same
        .iter()
        .filter_map(|(input, channel)| graph.input(input, channel))
        .collect();
    if has(material, &Channel::Emission) {
        inputs.push(constant("emission_luminance", "float", "1"));
    }
    if has(material, &Channel::Coat) {
        inputs.extend(graph.input("geometry_coat_normal", &Channel::Normal));
        // The coat of a material has this refractive index, and does not darken the layers below.
        inputs.push(constant("coat_ior", "float", "1.5"));
        inputs.push(constant("coat_darkening", "float", "0"));
    }
    if has(material, &Channel::Transmission) {
        // Light passes through as through thin glass, and is tinted by the base color.
        inputs.extend(graph.input("transmission_color", &Channel::BaseColor));
        inputs.push(constant("geometry_thin_walled", "boolean", "true"));
    }
    inputs.extend(weighted(
        graph,
        material,
        &Channel::Sheen,
        ["fuzz_weight", "fuzz_color"],
    ));
    let below = ["subsurface_weight", "subsurface_radius_scale"];
    inputs.extend(weighted(graph, material, &Channel::Subsurface, below));
    if has(material, &Channel::Subsurface) {
        inputs.extend(graph.input("subsurface_color", &Channel::BaseColor));
        inputs.push(constant("subsurface_radius", "float", list(&[SUBSURFACE_RADIUS])));
    }
    inputs.extend(drawn_out(graph, material));
    Shader {
        node: "open_pbr_surface",
        inputs,
    }
}

fn has(material: &DocumentMaterial, channel: &Channel) -> bool {
    material.channels.contains_key(channel)
}

/// A color as a weight, its largest component, and the color divided by it.
fn weighted(
    graph: &mut MaterialXGraph<'_>,
    material: &DocumentMaterial,
    channel: &Channel,
    [weight, color]: [&'static str; 2],
) -> Vec<XmlElement> {
    if let Some(ChannelSource::Value(value)) = material.channels.get(channel) {
        let values = [0, 1, 2].map(|index| value.component(index));
        let largest = values.into_iter().fold(LEAST, f32::max);
        return vec![
            constant(weight, "float", list(&[largest])),
            constant(color, "color3", list(&values.map(|value| value / largest))),
        ];
    }
    let Some(whole) = graph.channel(channel) else {
        return Vec::new();
    };
    let name = channel.name();
    let [red, green, blue] = [0, 1, 2].map(|index| graph.component(&whole, index));
    let two = graph.node("max", &format!("{name}_max_rg"), "float", &pair(&red, &green));
    let largest = graph.node("max", &format!("{name}_max"), "float", &pair(&two, &blue));
    let divisor = graph.arithmetic("max", &largest, LEAST);
    let divided = graph.node("divide", &format!("{name}_divided"), "color3", &pair(&whole, &divisor));
    vec![
        graph.output(weight, &format!("{name}_weight"), &largest),
        graph.output(color, &format!("{name}_color"), &divided),
    ]
}

fn pair<'a>(one: &'a MaterialXNode, other: &'a MaterialXNode) -> [(&'static str, NodeArgument<'a>); 2] {
    [("in1", NodeArgument::Node(one)), ("in2", NodeArgument::Node(other))]
}

/// Angle of a direction from the tangent toward the bitangent, radians.
fn rotation(value: ConstantValue) -> f32 {
    let [x, y] = [0, 1].map(|index| 2.0 * value.component(index) - 1.0);
    y.atan2(x)
}

/// Strength and rotation of the anisotropy in a file, as KHR_materials_anisotropy has them: a direction in red and green, −1..1
/// as 0..1, and the strength in blue.
fn anisotropy(graph: &mut MaterialXGraph<'_>) -> Option<[MaterialXNode; 2]> {
    let picture = graph.channel(&Channel::Anisotropy)?;
    let [x, y, strength] = [0, 1, 2].map(|index| graph.component(&picture, index));
    let [x, y] = [x, y].map(|axis| {
        let doubled = graph.arithmetic("multiply", &axis, 2.0);
        graph.arithmetic("subtract", &doubled, 1.0)
    });
    let arguments = [("iny", NodeArgument::Node(&y)), ("inx", NodeArgument::Node(&x))];
    Some([
        strength,
        graph.node("atan2", "anisotropy_rotation", "float", &arguments),
    ])
}

/// Returns the anisotropy of OpenPBR: a strength, and a tangent rotated toward the direction. OpenPBR interprets the
/// strength differently from glTF, so highlights have only approximately the same length.
fn drawn_out(graph: &mut MaterialXGraph<'_>, material: &DocumentMaterial) -> Vec<XmlElement> {
    let input = "specular_roughness_anisotropy";
    let (strength, turn) = match material.channels.get(&Channel::Anisotropy) {
        Some(ChannelSource::Value(value)) => {
            let strength = constant(input, "float", list(&[value.component(2)]));
            let turn = rotation(*value);
            if turn == 0.0 {
                return vec![strength];
            }
            (strength, TangentAngle::Value(turn))
        }
        Some(_) => match anisotropy(graph) {
            Some([strength, rotation]) => (
                graph.output(input, "anisotropy_strength", &strength),
                TangentAngle::Node(rotation),
            ),
            None => return Vec::new(),
        },
        None => return Vec::new(),
    };
    // MaterialX rotates in the opposite direction: bxdf/gltf_pbr.mtlx also multiplies by −180/π.
    let turn = match turn {
        TangentAngle::Value(radians) => TangentAngle::Value(-radians.to_degrees()),
        TangentAngle::Node(rotation) => {
            TangentAngle::Node(graph.arithmetic("multiply", &rotation, -180.0 / std::f32::consts::PI))
        }
    };
    let degrees = match &turn {
        TangentAngle::Value(degrees) => NodeArgument::Value("float", list(&[*degrees])),
        TangentAngle::Node(degrees) => NodeArgument::Node(degrees),
    };
    let (tangent, normal) = (graph.frame_vector("tangent"), graph.frame_vector("normal"));
    let arguments = [
        ("in", NodeArgument::Node(&tangent)),
        ("amount", degrees),
        ("axis", NodeArgument::Node(&normal)),
    ];
    let turned = graph.node("rotate3d", "turned_tangent", "vector3", &arguments);
    vec![strength, graph.output("geometry_tangent", "tangent", &turned)]
}

/// Angle that the tangent is turned by.
enum TangentAngle {
    Value(f32),
    Node(MaterialXNode),
}
