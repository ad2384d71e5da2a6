//! Reads `struct Params`: memory layout from naga, everything else from annotations.

mod defaults;
#[cfg(test)]
mod tests;

use std::ops::Range;

use naga::{ArraySize, Module, Scalar, ScalarKind, Type, TypeInner, VectorSize};

use crate::annotations::{Annotation, DocComment, PARAM_ANNOTATIONS, number};
use crate::fault::{Fault, Text};
use crate::kind::{Memory, Param, ParamType, ParamValue, Role, shortest_decimal};
use crate::names::{is_plain_name, label_of};
use crate::scan::{Member, Scan};

/// Annotations of roles; a parameter has at most one.
const ROLES: [&str; 8] = [
    "toggle", "choice", "color", "length", "angle", "seed", "extent", "curve",
];

/// Maximum number of gradient stops, and of points of a curve.
const POINTS_LIMIT: u32 = 16;

/// Range of the points of a curve that has no `@range`.
const CURVE_RANGE: [f64; 2] = [-1000.0, 1000.0];

/// Returns the type `Params` of a module.
pub(crate) fn params_type(module: &Module) -> Option<(naga::Handle<Type>, &Type)> {
    module.types.iter().find(|(_, ty)| ty.name.as_deref() == Some("Params"))
}

/// Returns the size of `struct Params` in bytes.
pub(crate) fn params_size(module: &Module) -> u32 {
    match params_type(module) {
        Some((
            _,
            Type {
                inner: TypeInner::Struct { span, .. },
                ..
            },
        )) => *span,
        _ => 0,
    }
}

/// Reads all parameters except those with faults.
pub(crate) fn read_params(text: Text<'_>, scan: &Scan, module: &Module, faults: &mut Vec<Fault>) -> Vec<Param> {
    let Some(item) = scan.params() else {
        return Vec::new();
    };
    let Some((
        _,
        Type {
            inner: TypeInner::Struct { members, .. },
            ..
        },
    )) = params_type(module)
    else {
        return Vec::new();
    };
    let mut params = Vec::new();
    for (member, reflected) in item.members.iter().zip(members) {
        let mut reader = ParamReader {
            text,
            member,
            members: &item.members,
            comment: DocComment::read(&member.docs),
            faults: Vec::new(),
        };
        let param = reader.param(module, reflected.ty, reflected.offset);
        if reader.faults.is_empty() {
            params.extend(param);
        }
        faults.append(&mut reader.faults);
    }
    params
}

/// Reads one parameter.
struct ParamReader<'a> {
    text: Text<'a>,
    member: &'a Member,
    members: &'a [Member],
    comment: DocComment,
    faults: Vec<Fault>,
}

impl ParamReader<'_> {
    fn param(&mut self, module: &Module, ty: naga::Handle<Type>, offset: u32) -> Option<Param> {
        let name = self.member.name.clone();
        let comment = self.comment.clone();
        comment.check(
            self.text,
            PARAM_ANNOTATIONS,
            &[&ROLES[..], &["range", "soft", "default", "label"]].concat(),
            &mut self.faults,
        );
        if !is_plain_name(&name) {
            self.at_name(
                format!("`{name}` cannot be the name of a parameter."),
                "Use lower-case letters, digits and `_`, and start with a letter.",
            );
        }
        let doc = comment.prose();
        if doc.is_empty() {
            self.at_name(
                format!("The parameter `{name}` is not described."),
                "Say in a `///` line above it what it changes.",
            );
        }
        let memory = self.memory(module, ty)?;
        let role = self.role(memory)?;
        // A curve always has a range, so that its slopes are finite.
        let widest = (role == Role::Curve).then_some(CURVE_RANGE);
        let range = self.ends("range", memory, &role).or(widest);
        let soft = self.ends("soft", memory, &role);
        let is_absolute = self.is_absolute(&role)?;
        if let (Some(range), Some(soft), Some(annotation)) = (range, soft, comment.get("soft"))
            && (soft[0] < range[0] || soft[1] > range[1])
        {
            self.at_annotation(
                annotation,
                format!("The slider goes outside of `@range {} {}`.", range[0], range[1]),
                "Make `@soft` a part of `@range`.",
            );
        }
        let default = self.default(memory, &role)?;
        let ty = ParamType {
            range,
            soft,
            ..ParamType::new(role, memory, &default)
        };
        self.check_in_range(&default, &ty);
        let formerly = comment.all("was").flat_map(|annotation| annotation.words.iter());
        Some(Param {
            label: self.label()?,
            doc,
            ty,
            offset,
            default,
            bounds_a_loop: false,
            // Set later, by the analysis of the functions.
            takes_mask: false,
            is_absolute,
            formerly: formerly.map(|word| word.text.clone()).collect(),
            name,
        })
    }

    fn label(&mut self) -> Option<String> {
        match self.comment.get("label").cloned() {
            Some(annotation) if annotation.words.is_empty() => {
                let advice = "Write the name behind it: `@label Tile size`.";
                self.at_annotation(&annotation, "`@label` gives no name.", advice);
                None
            }
            Some(annotation) => Some(annotation.joined()),
            None => Some(label_of(&self.member.name)),
        }
    }

    fn memory(&mut self, module: &Module, ty: naga::Handle<Type>) -> Option<Memory> {
        let found = match module.types.get_handle(ty).map(|ty| &ty.inner) {
            Ok(TypeInner::Scalar(scalar)) => scalar_type(*scalar),
            Ok(TypeInner::Vector {
                size,
                scalar: Scalar::F32,
            }) => Some(match size {
                VectorSize::Bi => Memory::Vec2,
                VectorSize::Tri => Memory::Vec3,
                VectorSize::Quad => Memory::Vec4,
            }),
            Ok(TypeInner::Array {
                base,
                size: ArraySize::Constant(count),
                ..
            }) => {
                let is_vec4 = matches!(
                    module.types.get_handle(*base).map(|ty| &ty.inner),
                    Ok(TypeInner::Vector {
                        size: VectorSize::Quad,
                        scalar: Scalar::F32
                    })
                );
                (is_vec4 && count.get() <= POINTS_LIMIT).then_some(Memory::Points(count.get()))
            }
            _ => None,
        };
        if found.is_none() {
            let written = &self.text.text[self.member.type_range.clone()];
            let advice = if written == "bool" {
                "Make a switch a `u32` with `@toggle`, and compare it with `!= 0u`.".to_owned()
            } else {
                format!(
                    "Use f32, u32, i32, vec2f, vec3f, vec4f, or `array<vec4f, N>` with N up to {POINTS_LIMIT} for gradient stops and curves."
                )
            };
            let message = format!("`{written}` cannot be the type of a parameter.");
            self.at(self.member.type_range.clone(), message, advice);
        }
        found
    }

    /// Reads the role of the parameter and checks that it suits the type.
    fn role(&mut self, memory: Memory) -> Option<Role> {
        let comment = self.comment.clone();
        let mut roles = comment
            .annotations
            .iter()
            .filter(|annotation| ROLES.contains(&annotation.name.as_str()));
        let Some(annotation) = roles.next() else {
            return Some(if matches!(memory, Memory::Points(_)) {
                Role::Stops
            } else {
                Role::Plain
            });
        };
        if let Some(other) = roles.find(|other| other.name != annotation.name) {
            let message = format!("`@{}` and `@{}` exclude each other.", annotation.name, other.name);
            self.at_annotation(other, message, "Keep the one that says what an artist sees.");
            return None;
        }
        let is_float = matches!(memory, Memory::F32 | Memory::Vec2 | Memory::Vec3 | Memory::Vec4);
        let (role, fits, needed) = match annotation.name.as_str() {
            "toggle" => (Role::Toggle, memory == Memory::U32, "u32"),
            "choice" => (Role::Choice(self.choices(annotation)?), memory == Memory::U32, "u32"),
            "color" => (Role::Color, memory == Memory::Vec3, "vec3f"),
            "length" => (Role::Length, is_float, "f32"),
            "angle" => (Role::Angle, is_float, "f32"),
            "extent" => (self.extent(annotation)?, memory == Memory::F32, "f32"),
            "curve" => (Role::Curve, matches!(memory, Memory::Points(_)), "array<vec4f, 16>"),
            _ => (Role::Seed, memory == Memory::U32, "u32"),
        };
        if !fits {
            let message = format!("A parameter with `@{}` must be of type `{needed}`.", annotation.name);
            let advice = format!("Write `{}: {needed},`.", self.member.name);
            self.at(self.member.type_range.clone(), message, advice);
            return None;
        }
        if !matches!(annotation.name.as_str(), "choice" | "extent") && !annotation.words.is_empty() {
            let message = format!("`@{}` takes nothing behind it.", annotation.name);
            self.at(
                words_range(annotation),
                message,
                "Put the description in front of the annotations.",
            );
            return None;
        }
        Some(role)
    }

    /// Reads `@extent low along`: an end of the model in the direction that another parameter holds.
    fn extent(&mut self, annotation: &Annotation) -> Option<Role> {
        let words: Vec<&str> = annotation.words.iter().map(|word| word.text.as_str()).collect();
        if let ([end @ ("low" | "high"), along], false) = (words.as_slice(), self.comment.get("default").is_some()) {
            let is_direction = |member: &&Member| {
                let ty = self.text.text.get(member.type_range.clone());
                member.name == *along && matches!(ty, Some("vec3f" | "vec3<f32>"))
            };
            if self.members.iter().any(|member| is_direction(&member)) {
                return Some(Role::Extent {
                    along: (*along).to_owned(),
                    high: *end == "high",
                });
            }
            let message = format!("`@extent` names `{along}`, which is not a parameter of type `vec3f`.");
            self.at_annotation(annotation, message, "Name the parameter that holds the direction.");
            return None;
        }
        let message = "`@extent` takes `low` or `high` and the name of a parameter, and has no default.";
        let advice = "Write `@extent low along`: the program fills it with the end of the model along that direction.";
        self.at_annotation(annotation, message, advice);
        None
    }

    fn choices(&mut self, annotation: &Annotation) -> Option<Vec<String>> {
        let mut words: Vec<String> = Vec::new();
        for word in &annotation.words {
            let text = word.text.trim_end_matches(',');
            if !is_plain_name(text) {
                let message = format!("`{text}` cannot be a choice.");
                let advice = "Choices are words of lower-case letters, digits and `_`; describe them above `@choice`.";
                self.at(word.range.clone(), message, advice);
                return None;
            }
            if words.iter().any(|known| known == text) {
                self.at(
                    word.range.clone(),
                    format!("The choice `{text}` stands here twice."),
                    "Remove one.",
                );
                return None;
            }
            words.push(text.to_owned());
        }
        if words.len() < 2 {
            self.at_annotation(
                annotation,
                "`@choice` needs at least two words.",
                "Write `@choice soft hard`.",
            );
            return None;
        }
        Some(words)
    }

    /// Reads `@range a b` or `@soft a b`.
    fn ends(&mut self, name: &str, memory: Memory, role: &Role) -> Option<[f64; 2]> {
        let comment = self.comment.clone();
        let annotation = comment.get(name)?;
        if !matches!(role, Role::Plain | Role::Length | Role::Angle | Role::Curve) {
            let advice = "Only numbers have a range.";
            self.at_annotation(annotation, format!("`@{name}` does not belong here."), advice);
            return None;
        }
        let ends = match annotation.words.as_slice() {
            [low, high] => number(low)
                .zip(number(high))
                .map(|(low, high)| (shortest_decimal(low), shortest_decimal(high))),
            _ => None,
        };
        let Some((low, high)) = ends.filter(|(low, high)| low < high) else {
            let advice = format!("Write `@{name} 0 1`.");
            self.at_annotation(
                annotation,
                format!("`@{name}` takes two numbers, the smaller one first."),
                advice,
            );
            return None;
        };
        let whole = low.fract() == 0.0 && high.fract() == 0.0 && high.abs().max(low.abs()) <= 16_777_216.0;
        let fits = match memory {
            Memory::U32 => whole && low >= 0.0,
            Memory::I32 => whole,
            _ => true,
        };
        if !fits {
            let message = format!(
                "`@{name}` of a whole number takes whole numbers{}.",
                if memory == Memory::U32 { " from 0 on" } else { "" }
            );
            self.at_annotation(annotation, message, "Write whole numbers, at most 16777216.");
            return None;
        }
        Some([low, high])
    }

    fn check_in_range(&mut self, default: &ParamValue, ty: &ParamType) {
        if let Some([low, high]) = ty.range
            && !ty.is_in_range(default)
            && let Some(annotation) = self.comment.get("default").cloned()
        {
            self.at_annotation(
                &annotation,
                format!("The default lies outside of `@range {low} {high}`."),
                "Change one of the two.",
            );
        }
    }

    fn at(&mut self, range: Range<usize>, message: impl Into<String>, advice: impl Into<String>) {
        self.faults.push(self.text.fault(range, message, advice));
    }

    fn at_name(&mut self, message: String, advice: &str) {
        self.at(self.member.name_range.clone(), message, advice);
    }

    fn at_annotation(&mut self, annotation: &Annotation, message: impl Into<String>, advice: impl Into<String>) {
        self.at(annotation.whole(), message, advice);
    }
}

fn words_range(annotation: &Annotation) -> Range<usize> {
    match (annotation.words.first(), annotation.words.last()) {
        (Some(first), Some(last)) => first.range.start..last.range.end,
        _ => annotation.range.clone(),
    }
}

fn scalar_type(scalar: Scalar) -> Option<Memory> {
    match (scalar.kind, scalar.width) {
        (ScalarKind::Float, 4) => Some(Memory::F32),
        (ScalarKind::Uint, 4) => Some(Memory::U32),
        (ScalarKind::Sint, 4) => Some(Memory::I32),
        _ => None,
    }
}
