//! Small FBX files, made in code as text and binary.

use sabi_surface::load::{LoadError, LoadOptions, load_bytes};
use sabi_surface::model::Model;

/// A value of an element.
#[derive(Clone)]
pub(crate) enum FbxValue {
    Id(i64),
    Number(f64),
    Text(String),
    Numbers(Vec<f64>),
    Indices(Vec<i32>),
    Bytes(Vec<u8>),
}

/// An element with values and elements below it.
#[derive(Clone)]
pub(crate) struct FbxElement {
    pub(crate) name: String,
    pub(crate) values: Vec<FbxValue>,
    pub(crate) below: Vec<FbxElement>,
}

pub(crate) fn text(text: &str) -> FbxValue {
    FbxValue::Text(text.into())
}

pub(crate) fn element(name: &str, values: Vec<FbxValue>, below: Vec<FbxElement>) -> FbxElement {
    FbxElement {
        name: name.into(),
        values,
        below,
    }
}

/// `Properties70` with properties of one or three numbers.
pub(crate) fn properties(entries: &[(&str, &str, &[f64])]) -> FbxElement {
    let property = |(name, kind, numbers): &(&str, &str, &[f64])| {
        let mut values = vec![text(name), text(kind), text(""), text("A")];
        values.extend(numbers.iter().map(|number| FbxValue::Number(*number)));
        element("P", values, vec![])
    };
    element("Properties70", vec![], entries.iter().map(property).collect())
}

/// A layer of values by corner, with indices where there are any.
pub(crate) fn layer(kind: &str, index: i64, list: &str, values: Vec<f64>, indices: Option<Vec<i32>>) -> FbxElement {
    let reference = if indices.is_some() { "IndexToDirect" } else { "Direct" };
    let mut below = vec![
        element("Name", vec![text(&format!("{list}{index}"))], vec![]),
        element("MappingInformationType", vec![text("ByPolygonVertex")], vec![]),
        element("ReferenceInformationType", vec![text(reference)], vec![]),
        element(list, vec![FbxValue::Numbers(values)], vec![]),
    ];
    if let Some(indices) = indices {
        below.push(element(
            &format!("{list}Index"),
            vec![FbxValue::Indices(indices)],
            vec![],
        ));
    }
    element(kind, vec![FbxValue::Id(index)], below)
}

/// A file under construction; its lists may be edited at will.
#[derive(Clone)]
pub(crate) struct Fbx {
    /// Up, front and side axes (0 to 2, negative ones as −1 − axis), and centimeters of a unit.
    pub(crate) axes: [i64; 3],
    pub(crate) unit_cm: f64,
    pub(crate) objects: Vec<FbxElement>,
    /// Child, parent, and the property of the parent.
    pub(crate) connections: Vec<(i64, i64, Option<String>)>,
}

impl Fbx {
    /// A square of side 100 in the plane z = 0 with UVs, in centimeters: geometry 1, node 2 called `board`.
    pub(crate) fn square() -> Fbx {
        let corners = [0.0, 0.0, 0.0, 100.0, 0.0, 0.0, 100.0, 100.0, 0.0, 0.0, 100.0, 0.0];
        let uvs = vec![0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0];
        let uvs = layer("LayerElementUV", 0, "UV", uvs, Some(vec![0, 1, 2, 3]));
        let mut file = Fbx {
            axes: [1, 2, 0],
            unit_cm: 1.0,
            objects: vec![mesh(1, &corners, &[0, 1, 2, -4], vec![uvs])],
            connections: vec![(1, 2, None)],
        };
        file.place(2, "board", &[]);
        file
    }

    /// Adds a node below the root.
    pub(crate) fn place(&mut self, id: i64, name: &str, entries: &[(&str, &str, &[f64])]) {
        self.add("Model", id, name, "Mesh", vec![properties(entries)]);
        self.connections.push((id, 0, None));
    }

    /// Adds an object.
    pub(crate) fn add(&mut self, kind: &str, id: i64, name: &str, class: &str, below: Vec<FbxElement>) {
        self.objects.push(object(kind, id, name, class, below));
    }

    /// Connects a child to a parent, or to one of its properties.
    pub(crate) fn connect(&mut self, child: i64, parent: i64, property: Option<&str>) {
        self.connections.push((child, parent, property.map(str::to_string)));
    }

    /// The geometry 1.
    pub(crate) fn geometry(&mut self) -> &mut FbxElement {
        &mut self.objects[0]
    }

    fn roots(&self) -> Vec<FbxElement> {
        let number = |name: &str, value: i64| {
            element(
                "P",
                vec![text(name), text("int"), text("Integer"), text(""), FbxValue::Id(value)],
                vec![],
            )
        };
        let mut settings: Vec<FbxElement> = Vec::new();
        for (name, axis) in ["UpAxis", "FrontAxis", "CoordAxis"].into_iter().zip(self.axes) {
            settings.push(number(name, if axis < 0 { -1 - axis } else { axis }));
            settings.push(number(&format!("{name}Sign"), if axis < 0 { -1 } else { 1 }));
        }
        let unit = vec![
            text("UnitScaleFactor"),
            text("double"),
            text("Number"),
            text(""),
            FbxValue::Number(self.unit_cm),
        ];
        settings.push(element("P", unit, vec![]));
        let connection = |(child, parent, property): &(i64, i64, Option<String>)| {
            let mut values = vec![
                text(if property.is_some() { "OP" } else { "OO" }),
                FbxValue::Id(*child),
                FbxValue::Id(*parent),
            ];
            values.extend(property.iter().map(|property| text(property)));
            element("C", values, vec![])
        };
        vec![
            element(
                "FBXHeaderExtension",
                vec![],
                vec![element("FBXVersion", vec![FbxValue::Id(7400)], vec![])],
            ),
            element(
                "GlobalSettings",
                vec![],
                vec![element("Properties70", vec![], settings)],
            ),
            element("Objects", vec![], self.objects.clone()),
            element("Connections", vec![], self.connections.iter().map(connection).collect()),
        ]
    }

    /// The file as text.
    pub(crate) fn text(&self) -> Vec<u8> {
        let mut file = "; FBX 7.4.0 project file\n".to_string();
        self.roots().iter().for_each(|root| write_text(root, &mut file));
        file.into_bytes()
    }

    /// The file as binary of version 7.4.
    pub(crate) fn binary(&self) -> Vec<u8> {
        let mut file = b"Kaydara FBX Binary  \0\x1a\0".to_vec();
        file.extend(7400u32.to_le_bytes());
        self.roots().iter().for_each(|root| write_binary(root, &mut file));
        file.extend([0; 13]);
        file
    }

    /// Loads it as binary with nothing beside it.
    pub(crate) fn load_with(&self, options: &LoadOptions) -> Result<Model, LoadError> {
        load_bytes("test.fbx", &self.binary(), &mut crate::builder::nothing, options)
    }

    /// Loads what must be good, and checks what every model promises.
    pub(crate) fn model(&self) -> Model {
        let model = self.load_with(&LoadOptions::default()).unwrap();
        crate::promises::check(&model);
        model
    }
}

/// A geometry of polygons, the last index of each as −1 − index.
pub(crate) fn mesh(id: i64, corners: &[f64], polygons: &[i32], layers: Vec<FbxElement>) -> FbxElement {
    let entries = layers.iter().map(|layer| {
        let kind = vec![
            element("Type", vec![text(&layer.name)], vec![]),
            element("TypedIndex", layer.values.clone(), vec![]),
        ];
        element("LayerElement", vec![], kind)
    });
    // Each layer element has a layer of its own number.
    let number = |layer: &FbxElement| match layer.values[..] {
        [FbxValue::Id(number)] => number,
        _ => 0,
    };
    let numbers: Vec<i64> = layers.iter().map(number).collect();
    let mut below = vec![
        element("Vertices", vec![FbxValue::Numbers(corners.to_vec())], vec![]),
        element("PolygonVertexIndex", vec![FbxValue::Indices(polygons.to_vec())], vec![]),
    ];
    let entries: Vec<FbxElement> = entries.collect();
    below.extend(layers);
    for layer in 0..=numbers.iter().copied().max().unwrap_or(0) {
        let of = entries.iter().zip(&numbers).filter(|(_, number)| **number == layer);
        below.push(element(
            "Layer",
            vec![FbxValue::Id(layer)],
            of.map(|(entry, _)| entry.clone()).collect(),
        ));
    }
    object("Geometry", id, "shape", "Mesh", below)
}

fn object(kind: &str, id: i64, name: &str, class: &str, below: Vec<FbxElement>) -> FbxElement {
    element(
        kind,
        vec![FbxValue::Id(id), text(&format!("{kind}::{name}")), text(class)],
        below,
    )
}

fn write_text(element: &FbxElement, file: &mut String) {
    *file += &format!("{}: ", element.name);
    let mut list = None;
    let words = element.values.iter().map(|value| match value {
        FbxValue::Id(id) => id.to_string(),
        FbxValue::Number(number) => format!("{number:?}"),
        FbxValue::Text(text) => format!("\"{text}\""),
        FbxValue::Numbers(numbers) => {
            list = Some(numbers.iter().map(f64::to_string).collect::<Vec<_>>());
            format!("*{}", numbers.len())
        }
        FbxValue::Indices(indices) => {
            list = Some(indices.iter().map(i32::to_string).collect());
            format!("*{}", indices.len())
        }
        FbxValue::Bytes(_) => "\"\"".to_string(),
    });
    let words: Vec<String> = words.collect();
    *file += &words.join(",");
    if let Some(list) = list {
        *file += &format!(" {{\na: {}\n}}\n", list.join(","));
    } else if element.below.is_empty() && !element.values.is_empty() {
        *file += "\n";
    } else {
        *file += " {\n";
        element.below.iter().for_each(|below| write_text(below, file));
        *file += "}\n";
    }
}

fn write_binary(element: &FbxElement, file: &mut Vec<u8>) {
    let start = file.len();
    let mut values = Vec::new();
    for value in &element.values {
        match value {
            FbxValue::Id(id) => values.extend([b"L".to_vec(), id.to_le_bytes().to_vec()].concat()),
            FbxValue::Number(number) => values.extend([b"D".to_vec(), number.to_le_bytes().to_vec()].concat()),
            FbxValue::Text(text) => {
                // In binary files the class follows the name.
                let text = match text.split_once("::") {
                    Some((class, name)) => format!("{name}\0\x01{class}"),
                    None => text.clone(),
                };
                values.extend(
                    [
                        b"S".to_vec(),
                        (text.len() as u32).to_le_bytes().to_vec(),
                        text.into_bytes(),
                    ]
                    .concat(),
                );
            }
            FbxValue::Numbers(numbers) => {
                let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
                values.extend(array(b'd', numbers.len(), &bytes));
            }
            FbxValue::Indices(indices) => {
                let bytes: Vec<u8> = indices.iter().flat_map(|index| index.to_le_bytes()).collect();
                values.extend(array(b'i', indices.len(), &bytes));
            }
            FbxValue::Bytes(bytes) => {
                values.extend(
                    [
                        b"R".to_vec(),
                        (bytes.len() as u32).to_le_bytes().to_vec(),
                        bytes.clone(),
                    ]
                    .concat(),
                );
            }
        }
    }
    file.extend([0; 4]);
    file.extend((element.values.len() as u32).to_le_bytes());
    file.extend((values.len() as u32).to_le_bytes());
    file.push(element.name.len() as u8);
    file.extend(element.name.as_bytes());
    file.extend(values);
    if !element.below.is_empty() {
        element.below.iter().for_each(|below| write_binary(below, file));
        file.extend([0; 13]);
    }
    let end = (file.len() as u32).to_le_bytes();
    file[start..start + 4].copy_from_slice(&end);
}

/// An array that is not compressed.
fn array(kind: u8, count: usize, bytes: &[u8]) -> Vec<u8> {
    let [count, length] = [count, bytes.len()].map(|number| (number as u32).to_le_bytes());
    [&[kind][..], &count, &[0; 4], &length, bytes].concat()
}
