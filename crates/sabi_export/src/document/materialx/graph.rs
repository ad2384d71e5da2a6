//! The graph of a material: pictures, their components, and outputs for the shaders.

use std::collections::BTreeSet;

use super::super::material::{ChannelSource, DocumentMap, DocumentMaterial};
use super::super::numbers::list;
use super::super::xml::XmlElement;
use crate::Channel;

/// Node graph under construction. Nodes and outputs are created when they are first requested.
pub(super) struct MaterialXGraph<'m> {
    material: &'m DocumentMaterial,
    name: String,
    nodes: Vec<XmlElement>,
    outputs: Vec<XmlElement>,
    made: BTreeSet<String>,
}

/// A value in the graph: the name and the type of its node.
#[derive(Clone, Debug)]
pub(super) struct MaterialXNode {
    pub(super) name: String,
    pub(super) ty: &'static str,
}

/// Argument of a node.
pub(super) enum NodeArgument<'a> {
    /// Result of another node.
    Node(&'a MaterialXNode),
    /// Value of a type.
    Value(&'static str, String),
}

impl<'m> MaterialXGraph<'m> {
    pub(super) fn new(material: &'m DocumentMaterial) -> MaterialXGraph<'m> {
        MaterialXGraph {
            material,
            name: format!("NG_{}", material.id),
            nodes: Vec::new(),
            outputs: Vec::new(),
            made: BTreeSet::new(),
        }
    }

    /// The element of the graph; none if nothing is in it.
    pub(super) fn finish(self) -> Option<XmlElement> {
        let mut element = XmlElement::new("nodegraph").with("name", self.name);
        if self.outputs.is_empty() {
            return None;
        }
        element.extend(self.nodes);
        element.extend(self.outputs);
        Some(element)
    }

    /// Returns an input of a shader with an unchanged channel; `None` if the material does not have the channel.
    pub(super) fn input(&mut self, input: &'static str, channel: &Channel) -> Option<XmlElement> {
        let (name, look) = (channel.name(), self.material.channels.get(channel)?);
        Some(match look {
            ChannelSource::Value(value) => {
                let (ty, values) = match value {
                    crate::ConstantValue::Number(number) => ("float", vec![*number]),
                    crate::ConstantValue::Triple(values) => ("color3", values.to_vec()),
                };
                constant(input, ty, list(&values))
            }
            ChannelSource::Rgb(_) | ChannelSource::Component { .. } => {
                let node = self.channel(channel)?;
                self.output(input, &name, &node)
            }
        })
    }

    /// The node with a channel that is in a file; none if it is in no file.
    pub(super) fn channel(&mut self, channel: &Channel) -> Option<MaterialXNode> {
        match *self.material.channels.get(channel)? {
            ChannelSource::Value(_) => None,
            ChannelSource::Rgb(map) => {
                let picture = self.picture(map)?;
                // All components of a color have the same divisor.
                let [[scale, _], ..] = self.material.maps.get(map)?.decoding;
                let is_scaled = *channel != Channel::Normal && scale != 1.0;
                let made = match (channel, picture.ty) {
                    (Channel::Normal, "vector4" | "color4" | "color3") => {
                        let plain = self.converted(&picture, "vector3");
                        self.normal(&plain)
                    }
                    (Channel::Normal, _) => self.normal(&picture),
                    (_, "color4") => self.converted(&picture, "color3"),
                    _ => picture,
                };
                Some(match is_scaled {
                    true => self.arithmetic("multiply", &made, scale),
                    false => made,
                })
            }
            ChannelSource::Component { map, index } => {
                let picture = self.picture(map)?;
                let [scale, bias] = self.material.maps.get(map)?.decoding.get(index).copied()?;
                let mut value = match picture.ty {
                    "float" => picture,
                    _ => self.component(&picture, index),
                };
                if scale != 1.0 {
                    value = self.arithmetic("multiply", &value, scale);
                }
                if bias != 0.0 {
                    value = self.arithmetic("add", &value, bias);
                }
                Some(value)
            }
        }
    }

    /// An input of a shader that reads a node, over an output of the graph.
    pub(super) fn output(&mut self, input: &'static str, name: &str, node: &MaterialXNode) -> XmlElement {
        let output = format!("out_{name}");
        if self.made.insert(output.clone()) {
            let element = XmlElement::new("output")
                .with("name", &output)
                .with("type", node.ty)
                .with("nodename", &node.name);
            self.outputs.push(element);
        }
        XmlElement::new("input")
            .with("name", input)
            .with("type", node.ty)
            .with("nodegraph", &self.name)
            .with("output", output)
    }

    /// A node of the category `tag`, unless one of that name is there.
    pub(super) fn node(
        &mut self,
        tag: &'static str,
        name: &str,
        ty: &'static str,
        arguments: &[(&'static str, NodeArgument<'_>)],
    ) -> MaterialXNode {
        let node = MaterialXNode {
            name: name.to_owned(),
            ty,
        };
        if !self.made.insert(node.name.clone()) {
            return node;
        }
        let mut element = XmlElement::new(tag).with("name", name).with("type", ty);
        element.extend(arguments.iter().map(|(input, argument)| {
            match argument {
                NodeArgument::Value(ty, value) => constant(input, ty, value.clone()),
                NodeArgument::Node(of) => XmlElement::new("input")
                    .with("name", *input)
                    .with("type", of.ty)
                    .with("nodename", &of.name),
            }
        }));
        self.nodes.push(element);
        node
    }

    /// Returns a component of an image.
    pub(super) fn component(&mut self, picture: &MaterialXNode, index: usize) -> MaterialXNode {
        let name = format!("{}_{index}", picture.name);
        let index = NodeArgument::Value("integer", index.to_string());
        let arguments = [("in", NodeArgument::Node(picture)), ("index", index)];
        self.node("extract", &name, "float", &arguments)
    }

    /// A value with a number, by a node of two arguments.
    pub(super) fn arithmetic(&mut self, tag: &'static str, value: &MaterialXNode, number: f32) -> MaterialXNode {
        let number = NodeArgument::Value("float", list(&[number]));
        let arguments = [("in1", NodeArgument::Node(value)), ("in2", number)];
        self.node(tag, &format!("{}_{tag}", value.name), value.ty, &arguments)
    }

    fn converted(&mut self, value: &MaterialXNode, ty: &'static str) -> MaterialXNode {
        let name = format!("{}_{ty}", value.name);
        self.node("convert", &name, ty, &[("in", NodeArgument::Node(value))])
    }

    /// Returns the normal of the geometry, modified by a normal map.
    fn normal(&mut self, picture: &MaterialXNode) -> MaterialXNode {
        let frame = self.frame();
        let mut arguments = vec![("in", NodeArgument::Node(picture))];
        for (input, node) in ["tangent", "bitangent"].into_iter().zip(frame.iter().flatten()) {
            arguments.push((input, NodeArgument::Node(node)));
        }
        self.node("normalmap", "normal_map", "vector3", &arguments)
    }

    /// Returns tangent and bitangent of the UV set of the maps; `None` for the first set, which shaders use by default.
    fn frame(&mut self) -> Option<[MaterialXNode; 2]> {
        (self.material.uv_set != 0).then(|| ["tangent", "bitangent"].map(|tag| self.frame_vector(tag)))
    }

    /// A vector of the tangent frame, world space.
    pub(super) fn frame_vector(&mut self, tag: &'static str) -> MaterialXNode {
        let space = ("space", NodeArgument::Value("string", "world".to_owned()));
        let index = (
            "index",
            NodeArgument::Value("integer", self.material.uv_set.to_string()),
        );
        let arguments = [space, index];
        // Normals do not depend on a UV set.
        let count = if tag == "normal" { 1 } else { 2 };
        self.node(tag, &format!("world_{tag}"), "vector3", &arguments[..count])
    }

    /// A file of the material.
    fn picture(&mut self, map: usize) -> Option<MaterialXNode> {
        let maps = &self.material.maps;
        let file = maps.get(map)?;
        let ty = self.picture_type(map, file);
        let name = format!("image_{}", file.id);
        if self.made.contains(&name) {
            return Some(MaterialXNode { name, ty });
        }
        let mut path = XmlElement::new("input")
            .with("name", "file")
            .with("type", "filename")
            .with("value", &file.file);
        if file.is_srgb {
            path = path.with("colorspace", "srgb_texture");
        }
        let mut element = XmlElement::new("image")
            .with("name", &name)
            .with("type", ty)
            .holding(path);
        if self.is_rgb_of(map, &Channel::Normal) {
            // If the file is missing, the surface stays flat.
            element.extend([constant("default", ty, flat_normal(ty))]);
        }
        if self.material.uv_set != 0 {
            let index = [(
                "index",
                NodeArgument::Value("integer", self.material.uv_set.to_string()),
            )];
            let uv = self.node("texcoord", "uv", "vector2", &index);
            element.extend([XmlElement::new("input")
                .with("name", "texcoord")
                .with("type", uv.ty)
                .with("nodename", &uv.name)]);
        }
        self.made.insert(name.clone());
        self.nodes.push(element);
        Some(MaterialXNode { name, ty })
    }

    /// Returns the type of a file's pixels: color management is applied to colors but not to numbers. Alpha is read only
    /// from four components.
    fn picture_type(&self, map: usize, file: &DocumentMap) -> &'static str {
        let colors = [
            Channel::BaseColor,
            Channel::Emission,
            Channel::Sheen,
            Channel::Subsurface,
        ];
        let is_color = file.is_srgb || colors.iter().any(|channel| self.is_rgb_of(map, channel));
        let reads_alpha = self.material.channels.values().any(|look| {
            let ChannelSource::Component { map: of, index } = look else {
                return false;
            };
            *of == map && *index == 3
        });
        match (is_color, reads_alpha) {
            (false, _) if file.components < 3 => "float",
            (true, true) => "color4",
            (true, false) => "color3",
            (false, true) => "vector4",
            (false, false) => "vector3",
        }
    }

    fn is_rgb_of(&self, map: usize, channel: &Channel) -> bool {
        self.material.channels.get(channel) == Some(&ChannelSource::Rgb(map))
    }
}

/// An input with a value.
pub(super) fn constant(name: &'static str, ty: &'static str, value: impl Into<String>) -> XmlElement {
    XmlElement::new("input")
        .with("name", name)
        .with("type", ty)
        .with("value", value)
}

fn flat_normal(ty: &str) -> String {
    let flat = [0.5, 0.5, 1.0, 1.0];
    list(&flat[..if ty.ends_with('4') { 4 } else { 3 }])
}
