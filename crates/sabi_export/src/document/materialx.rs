//! MaterialX 1.39: each material becomes a graph of its files, with the shaders `gltf_pbr` and `open_pbr_surface`, which read the graph.
//!
//! Source of the names of inputs: the libraries of MaterialX 1.39.5, `bxdf/gltf_pbr.mtlx` and `bxdf/open_pbr_surface.mtlx`.

mod graph;
mod shaders;

use self::graph::MaterialXGraph;
use self::shaders::{Shader, gltf, open_pbr};
use super::material::DocumentMaterial;
use super::xml::XmlElement;
use crate::Channel;

/// Text of a document.
pub(super) fn text(materials: &[DocumentMaterial]) -> String {
    let mut root = XmlElement::new("materialx")
        .with("version", "1.39")
        .with("colorspace", "lin_rec709");
    for material in materials {
        root.extend(elements(material));
    }
    root.document()
}

/// Returns the names of the two MaterialX materials that represent a material.
pub(super) fn names(material: &DocumentMaterial) -> [String; 2] {
    ["gltf_pbr", "open_pbr_surface"].map(|shader| format!("M_{}_{shader}", material.id))
}

/// The graph of a material, its shaders and materials.
fn elements(material: &DocumentMaterial) -> Vec<XmlElement> {
    let mut graph = MaterialXGraph::new(material);
    let shaders = [gltf(material, &mut graph), open_pbr(material, &mut graph)];
    let displacement = displacement(material, &mut graph);
    let mut elements: Vec<XmlElement> = graph.finish().into_iter().collect();
    let height = displacement.as_ref().map(|_| displacement_name(material));
    elements.extend(displacement);
    for (Shader { node, inputs }, name) in shaders.into_iter().zip(names(material)) {
        let shader_name = format!("SR_{}_{node}", material.id);
        let mut shader = XmlElement::new(node)
            .with("name", &shader_name)
            .with("type", "surfaceshader");
        shader.extend(inputs);
        elements.push(shader);
        let mut made = XmlElement::new("surfacematerial")
            .with("name", name)
            .with("type", "material");
        if material.name != material.id {
            made = made.with("uiname", &material.name);
        }
        made.extend([connected("surfaceshader", "surfaceshader", &shader_name)]);
        made.extend(
            height
                .iter()
                .map(|name| connected("displacementshader", "displacementshader", name)),
        );
        elements.push(made);
    }
    elements
}

/// Displacement by the height, which is in the units of the model.
fn displacement(material: &DocumentMaterial, graph: &mut MaterialXGraph<'_>) -> Option<XmlElement> {
    let height = graph.input("displacement", &Channel::Height)?;
    let node = XmlElement::new("displacement")
        .with("name", displacement_name(material))
        .with("type", "displacementshader");
    Some(node.holding(height))
}

fn displacement_name(material: &DocumentMaterial) -> String {
    format!("DS_{}", material.id)
}

/// An input that reads a node.
fn connected(name: &'static str, ty: &'static str, node: &str) -> XmlElement {
    XmlElement::new("input")
        .with("name", name)
        .with("type", ty)
        .with("nodename", node)
}
