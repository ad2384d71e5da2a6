//! Reads inputs: arguments of documented functions, described by `@input`.

use std::ops::Range;

use naga::{Module, TypeInner};
use sabi_graph::{PortType, Value};

use super::{FunctionDraft, PortReader, is_field, port_type};
use crate::annotations::{Annotation, number};
use crate::color::color_linear;
use crate::fault::{Fault, Text};
use crate::kind::{Input, InputDefault, Reads};
use crate::names::{is_plain_name, label_of};
use crate::scan::Member;
use crate::words::nearest;

/// An annotation `@input name …`, and the annotations after it.
#[derive(Clone, Debug)]
pub(super) struct InputAnnotations {
    pub(super) name: String,
    /// Place of `@input name …`.
    pub(super) range: Range<usize>,
    doc: String,
    label: Option<String>,
    optional: Option<Range<usize>>,
    default: Option<Annotation>,
    starts: Option<Annotation>,
    ty: Option<(PortType, Range<usize>)>,
}

impl InputAnnotations {
    /// Creates the annotations of an input from `@input name text`.
    pub(super) fn begin(text: Text<'_>, annotation: &Annotation, faults: &mut Vec<Fault>) -> Option<InputAnnotations> {
        let Some((name, words)) = annotation.words.split_first() else {
            faults.push(text.fault(
                annotation.range.clone(),
                "`@input` names no argument.",
                "Write `@input mask Where it shows.`",
            ));
            return None;
        };
        let words: Vec<&str> = words.iter().map(|word| word.text.as_str()).collect();
        if words.is_empty() {
            faults.push(text.fault(
                annotation.whole(),
                format!("The input `{}` is not described.", name.text),
                format!("Say behind `@input {}` what it does.", name.text),
            ));
        }
        Some(InputAnnotations {
            name: name.text.clone(),
            range: annotation.range.start..name.range.end,
            doc: words.join(" "),
            label: None,
            optional: None,
            default: None,
            starts: None,
            ty: None,
        })
    }

    /// Adds an annotation that follows `@input`.
    pub(super) fn add(&mut self, text: Text<'_>, annotation: &Annotation, faults: &mut Vec<Fault>) {
        let range = annotation.whole();
        let twice = match annotation.name.as_str() {
            "optional" => self.optional.replace(range.clone()).is_some(),
            "default" => self.default.replace(annotation.clone()).is_some(),
            "starts" => self.starts.replace(annotation.clone()).is_some(),
            "label" => self.label.replace(annotation.joined()).is_some(),
            "vector" => self.ty.replace((PortType::Vector, range.clone())).is_some(),
            _ => {
                let named = PortType::ALL
                    .into_iter()
                    .find(|ty| ty.to_string() == annotation.joined());
                match named {
                    Some(ty) => self.ty.replace((ty, range.clone())).is_some(),
                    None => {
                        faults.push(text.fault(
                            range,
                            "`@type` takes a port type.",
                            "Write `@type` with one of `mask`, `color`, `vector` and `material`.",
                        ));
                        return;
                    }
                }
            }
        };
        let takes_words = matches!(annotation.name.as_str(), "default" | "label" | "type" | "starts");
        if twice {
            faults.push(text.fault(
                range,
                format!("The input `{}` has `@{}` twice.", self.name, annotation.name),
                "Keep one of them.",
            ));
        } else if takes_words == annotation.words.is_empty() {
            let (message, advice) = if takes_words {
                ("takes a value behind it", "Write the value behind it.")
            } else {
                (
                    "takes nothing behind it",
                    "Put the description directly behind `@input name`.",
                )
            };
            faults.push(text.fault(range, format!("`@{}` {message}.", annotation.name), advice));
        }
    }
}

/// Reads an argument that is an input port.
pub(super) fn read_input(
    reader: &mut PortReader<'_>,
    draft: &FunctionDraft<'_>,
    member: &Member,
    ty: &naga::Type,
) -> Option<Input> {
    let name = member.name.as_str();
    if !is_plain_name(name) {
        reader.at(
            member.name_range.clone(),
            format!("`{name}` cannot be the name of an input."),
            "Use lower-case letters, digits and `_`, and start with a letter.",
        );
        return None;
    }
    if reader.params.iter().any(|param| param.name == name) {
        reader.at(
            member.name_range.clone(),
            format!("`{name}` is both an input and a parameter."),
            "Give one of them another name; a value input has a knob of its own anyway.",
        );
        return None;
    }
    let Some(annotations) = reader.described.get(name).cloned() else {
        let meant = nearest(name, reader.described.keys().map(String::as_str));
        let advice = match meant {
            Some(meant) => format!("Is it what `@input {meant}` means?"),
            None => format!("Add `/// @input {name} What it does.` above the function."),
        };
        let message = format!("The input `{name}` is not described.");
        reader.at(member.name_range.clone(), message, advice);
        return None;
    };
    let (reads, port) = input_type(reader, draft, member, ty, &annotations)?;
    let default = match reads {
        Reads::Field => field_default(reader, &annotations)?,
        Reads::Value => value_default(reader, port, &annotations)?,
    };
    let starts = match &annotations.starts {
        Some(annotation) => Some(starts(reader, annotation)?),
        None => None,
    };
    Some(Input {
        name: name.to_owned(),
        label: annotations.label.clone().unwrap_or_else(|| label_of(name)),
        doc: annotations.doc.clone(),
        ty: port,
        reads,
        default,
        starts,
    })
}

/// Reads `@starts parameter value`.
fn starts(reader: &mut PortReader<'_>, annotation: &Annotation) -> Option<(String, Value)> {
    if let [name, value] = annotation.words.as_slice()
        && let Some(param) = reader.params.iter().find(|param| param.name == name.text)
        && let Ok(value) = param.ty.parse(&value.text)
    {
        return Some((name.text.clone(), value));
    }
    reader.at(
        annotation.whole(),
        "`@starts` takes a parameter, and the value that it gets once a wire is connected.",
        "Write `@starts height 0.01`.",
    );
    None
}

fn input_type(
    reader: &mut PortReader<'_>,
    draft: &FunctionDraft<'_>,
    member: &Member,
    ty: &naga::Type,
    annotations: &InputAnnotations,
) -> Option<(Reads, PortType)> {
    let declared = annotations.ty.clone();
    if is_field(ty) {
        let port = declared.map_or(draft.port().unwrap_or(PortType::Mask), |(ty, _)| ty);
        if port == PortType::Material {
            reader.at(
                member.type_range.clone(),
                format!(
                    "The input `{}` is a texture, and a texture cannot hold a material.",
                    member.name
                ),
                "Say with `@type mask`, `@type color` or `@type vector` what it holds.",
            );
            return None;
        }
        return Some((Reads::Field, port));
    }
    let is_vector = matches!(declared, Some((PortType::Vector, _)));
    let Some(port) = port_type(ty, is_vector) else {
        reader.at(
            member.type_range.clone(),
            format!("The input `{}` has a type that no port carries.", member.name),
            "Use f32 (a mask), vec3f (a color, or a vector with `@vector`), Material, or texture_2d_array<f32> for a stored result.",
        );
        return None;
    };
    if let Some((declared, range)) = declared
        && declared != port
    {
        let message = format!(
            "The input `{}` is a {port} by its type in the code, not a {declared}.",
            member.name
        );
        reader.at(range, message, "Change the type of the argument, or remove this.");
        return None;
    }
    Some((Reads::Value, port))
}

/// Checks that an input that reads a stored result has no default.
fn field_default(reader: &mut PortReader<'_>, annotations: &InputAnnotations) -> Option<InputDefault> {
    let range = annotations
        .default
        .as_ref()
        .map(Annotation::whole)
        .or(annotations.optional.clone());
    let Some(range) = range else {
        return Some(InputDefault::Required);
    };
    reader.at(
        range,
        format!(
            "The input `{}` is a texture, so it must be connected.",
            annotations.name
        ),
        "Remove `@optional` and `@default`.",
    );
    None
}

fn value_default(reader: &mut PortReader<'_>, ty: PortType, annotations: &InputAnnotations) -> Option<InputDefault> {
    let Some(annotation) = &annotations.default else {
        return Some(match ty {
            PortType::Mask => InputDefault::Knob(vec![1.0]),
            PortType::Color | PortType::Vector => InputDefault::Knob(vec![0.0; 3]),
            PortType::Material => InputDefault::PlainMaterial,
        });
    };
    let written = annotation.joined();
    if ty == PortType::Material {
        reader.at(
            annotation.whole(),
            "A material input has no default of its own: it starts plain gray.",
            "Remove `@default`.",
        );
        return None;
    }
    if written.starts_with("at.") {
        return expression(reader, ty, annotation, &written);
    }
    let color = if ty == PortType::Color {
        color_linear(&written)
    } else {
        None
    };
    let numbers: Option<Vec<f32>> = annotation.words.iter().map(number).collect();
    let count = if ty == PortType::Mask { 1 } else { 3 };
    let knob = color
        .map(|color| color.to_vec())
        .or(numbers.filter(|numbers| numbers.len() == count));
    if knob.is_none() {
        let (what, example) = match ty {
            PortType::Mask => ("one number", "1"),
            PortType::Color => ("`#rrggbb`", "#808080"),
            _ => ("three numbers", "0 1 0"),
        };
        reader.at(
            annotation.whole(),
            format!("The default of a {ty} input is {what}, or a member of the place."),
            format!("Write `@default {example}` or `@default at.position`."),
        );
    }
    knob.map(InputDefault::Knob)
}

/// Reads a default such as `at.position`: a member of the surface point that has the type of the input.
fn expression(
    reader: &mut PortReader<'_>,
    ty: PortType,
    annotation: &Annotation,
    written: &str,
) -> Option<InputDefault> {
    if member_of_place(reader.module, written).is_some_and(|count| count == if ty == PortType::Mask { 1 } else { 3 }) {
        return Some(InputDefault::Expression(written.to_owned()));
    }
    let needed = if ty == PortType::Mask { "f32" } else { "vec3f" };
    reader.at(
        annotation.whole(),
        format!("`{written}` is not a {needed} of the place."),
        "Write a member of `Surface`, such as `at.position`, or some of its components, such as `at.tangent.xyz`.",
    );
    None
}

/// Returns the number of floats in `at.member` or `at.member.xyz`.
fn member_of_place(module: &Module, path: &str) -> Option<usize> {
    let mut parts = path.split('.').skip(1);
    let name = parts.next()?;
    let (_, surface) = module
        .types
        .iter()
        .find(|(_, ty)| ty.name.as_deref() == Some("Surface"))?;
    let TypeInner::Struct { members, .. } = &surface.inner else {
        return None;
    };
    let member = members.iter().find(|member| member.name.as_deref() == Some(name))?;
    let count = match module.types.get_handle(member.ty).ok()?.inner {
        TypeInner::Scalar(naga::Scalar::F32) => 1,
        TypeInner::Vector {
            size,
            scalar: naga::Scalar::F32,
        } => size as usize,
        _ => return None,
    };
    let Some(swizzle) = parts.next() else {
        return Some(count);
    };
    let known = &"xyzw"[..count];
    let fits = count > 1 && (1..=4).contains(&swizzle.len()) && swizzle.chars().all(|c| known.contains(c));
    (fits && parts.next().is_none()).then_some(swizzle.len())
}
