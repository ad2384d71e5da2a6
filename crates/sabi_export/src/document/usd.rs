//! USD as text: for each material a network of UsdPreviewSurface and one UsdUVTexture for each file.
//!
//! Source: the UsdPreviewSurface specification, 2.6.

use std::fmt::Write as _;

use super::material::{ChannelSource, DocumentMap, DocumentMaterial};
use super::numbers::list;
use crate::{Channel, ConstantValue};

/// Root of the materials.
const ROOT: &str = "Materials";
/// Scale and bias to compute each component of a normal from a number in 0..1. Float files contain such numbers, too.
const NORMAL: [[f32; 2]; 4] = [[2.0, -1.0], [2.0, -1.0], [2.0, -1.0], [1.0, 0.0]];
const PLAIN: [[f32; 2]; 4] = [[1.0, 0.0]; 4];
/// Outputs of a texture.
const OUTPUTS: [&str; 5] = ["rgb", "r", "g", "b", "a"];

/// Text of a document.
pub(super) fn text(materials: &[DocumentMaterial]) -> String {
    let mut text = format!(
        "#usda 1.0\n(\n    defaultPrim = \"{ROOT}\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n)\n\ndef Scope \"{ROOT}\"\n{{\n"
    );
    for (at, material) in materials.iter().enumerate() {
        if at > 0 {
            text.push('\n');
        }
        write_material(&mut text, material);
    }
    text.push_str("}\n");
    text
}

/// Path of a material in its document.
pub(super) fn path(material: &DocumentMaterial) -> String {
    format!("/{ROOT}/{}", material.id)
}

/// Type and name of the input of UsdPreviewSurface for a channel; none for those that it does not have.
pub(super) fn input(channel: &Channel) -> Option<(&'static str, &'static str)> {
    Some(match channel {
        Channel::BaseColor => ("color3f", "diffuseColor"),
        Channel::Opacity => ("float", "opacity"),
        Channel::Roughness => ("float", "roughness"),
        Channel::Metallic => ("float", "metallic"),
        Channel::Occlusion => ("float", "occlusion"),
        Channel::Height => ("float", "displacement"),
        Channel::Normal => ("normal3f", "normal"),
        Channel::Emission => ("color3f", "emissiveColor"),
        Channel::Coat => ("float", "clearcoat"),
        Channel::CoatRoughness => ("float", "clearcoatRoughness"),
        Channel::Anisotropy
        | Channel::Sheen
        | Channel::SheenRoughness
        | Channel::Subsurface
        | Channel::Transmission
        | Channel::Mask(_)
        | Channel::Color(_)
        | Channel::Vector(_)
        | Channel::Mesh(_) => return None,
    })
}

/// Names of the files that a material reads, those of all tiles.
pub(super) fn files(material: &DocumentMaterial) -> impl Iterator<Item = &str> {
    let maps = material.maps.iter().enumerate();
    let read = maps.filter(|(at, _)| !outputs(material, *at).is_empty());
    read.flat_map(|(_, map)| map.files.iter().map(String::as_str))
}

fn write_material(text: &mut String, material: &DocumentMaterial) {
    let path = path(material);
    let mut lines = UsdBlock { text, depth: 1 };
    let name = match material.name == material.id {
        true => String::new(),
        false => format!(
            " (\n        customData = {{\n            string material = {}\n        }}\n    )",
            quoted(&material.name)
        ),
    };
    lines.line(&format!("def Material \"{}\"{name}", material.id));
    lines.open();
    lines.line(&format!(
        "token outputs:surface.connect = <{path}/Surface.outputs:surface>"
    ));
    if material.channels.contains_key(&Channel::Height) {
        lines.line(&format!(
            "token outputs:displacement.connect = <{path}/Surface.outputs:displacement>"
        ));
    }
    lines.line("");
    surface(&mut lines, material, &path);
    if !material.maps.is_empty() {
        lines.line("");
        lines.shader("Texcoord", "UsdPrimvarReader_float2");
        // The names that programs use for the UV sets of a model.
        let primvar = match material.uv_set {
            0 => "st".to_owned(),
            set => format!("st{set}"),
        };
        lines.line(&format!("string inputs:varname = \"{primvar}\""));
        lines.line("float2 outputs:result");
        lines.close();
    }
    for (at, map) in material.maps.iter().enumerate() {
        texture(&mut lines, material, at, map, &path);
    }
    lines.close();
}

/// The surface of a material.
fn surface(lines: &mut UsdBlock<'_>, material: &DocumentMaterial, path: &str) {
    lines.shader("Surface", "UsdPreviewSurface");
    for (channel, look) in &material.channels {
        let Some((ty, input)) = input(channel) else { continue };
        match look {
            ChannelSource::Value(ConstantValue::Number(number)) => {
                lines.line(&format!("{ty} inputs:{input} = {number}"))
            }
            ChannelSource::Value(ConstantValue::Triple(values)) => {
                lines.line(&format!("{ty} inputs:{input} = ({})", list(values)))
            }
            ChannelSource::Rgb(map) | ChannelSource::Component { map, .. } => {
                let Some(texture) = material.maps.get(*map) else {
                    continue;
                };
                let output = output(look);
                lines.line(&format!(
                    "{ty} inputs:{input}.connect = <{path}/{}.outputs:{output}>",
                    texture.id
                ));
            }
        }
    }
    if material.channels.contains_key(&Channel::Opacity) {
        // Where the surface is transparent, there is no reflection either.
        lines.line("token inputs:opacityMode = \"presence\"");
    }
    lines.line("token outputs:surface");
    if material.channels.contains_key(&Channel::Height) {
        lines.line("token outputs:displacement");
    }
    lines.close();
}

/// A file of a material, if the surface reads it.
fn texture(lines: &mut UsdBlock<'_>, material: &DocumentMaterial, at: usize, map: &DocumentMap, path: &str) {
    let outputs = outputs(material, at);
    if outputs.is_empty() {
        return;
    }
    lines.line("");
    lines.shader(&map.id, "UsdUVTexture");
    lines.line(&format!("asset inputs:file = {}", asset(&map.file)));
    let space = if map.is_srgb { "sRGB" } else { "raw" };
    lines.line(&format!("token inputs:sourceColorSpace = \"{space}\""));
    let is_normal = material.channels.get(&Channel::Normal) == Some(&ChannelSource::Rgb(at));
    let decoding = if is_normal { NORMAL } else { map.decoding };
    if decoding != PLAIN {
        for (name, index) in [("scale", 0), ("bias", 1)] {
            let values = list(&decoding.map(|pair| pair[index]));
            lines.line(&format!("float4 inputs:{name} = ({values})"));
        }
    }
    lines.line("token inputs:wrapS = \"repeat\"");
    lines.line("token inputs:wrapT = \"repeat\"");
    lines.line(&format!("float2 inputs:st.connect = <{path}/Texcoord.outputs:result>"));
    for output in outputs {
        let ty = if output == "rgb" { "float3" } else { "float" };
        lines.line(&format!("{ty} outputs:{output}"));
    }
    lines.close();
}

/// Outputs of a texture that the surface reads.
fn outputs(material: &DocumentMaterial, at: usize) -> Vec<&'static str> {
    let reads = |look: &ChannelSource| match look {
        ChannelSource::Value(_) => false,
        ChannelSource::Rgb(map) | ChannelSource::Component { map, .. } => *map == at,
    };
    let taken = material
        .channels
        .iter()
        .filter(|(channel, look)| input(channel).is_some() && reads(look));
    let read: Vec<&str> = taken.map(|(_, look)| output(look)).collect();
    OUTPUTS.into_iter().filter(|output| read.contains(output)).collect()
}

/// Name of the output of a texture that gives the channel.
fn output(look: &ChannelSource) -> &'static str {
    match look {
        // A file has at most four components.
        ChannelSource::Component { index, .. } => OUTPUTS.get(index + 1).copied().unwrap_or("r"),
        ChannelSource::Rgb(_) | ChannelSource::Value(_) => "rgb",
    }
}

/// Formats a path beside the document. Between `@@@`, a path may contain `@`.
fn asset(file: &str) -> String {
    match file.contains('@') {
        true => format!("@@@./{}@@@", file.replace("@@@", "\\@@@")),
        false => format!("@./{file}@"),
    }
}

fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

/// Lines of a block.
struct UsdBlock<'t> {
    text: &'t mut String,
    depth: usize,
}

impl UsdBlock<'_> {
    /// Adds a line; an empty one is not indented.
    fn line(&mut self, line: &str) {
        if !line.is_empty() {
            self.text.push_str(&"    ".repeat(self.depth));
        }
        // Writing to a string cannot fail.
        let _ = writeln!(self.text, "{line}");
    }

    fn open(&mut self) {
        self.line("{");
        self.depth += 1;
    }

    fn close(&mut self) {
        self.depth = self.depth.saturating_sub(1);
        self.line("}");
    }

    fn shader(&mut self, name: &str, id: &str) {
        self.line(&format!("def Shader \"{name}\""));
        self.open();
        self.line(&format!("uniform token info:id = \"{id}\""));
    }
}
