//! Reads the doc comments of functions: results and inputs.

use std::ops::Range;

use super::formulas::read_formula;
use super::inputs::InputAnnotations;
use crate::annotations::{Annotation, DocComment, FUNCTION_ANNOTATIONS, unknown_annotation};
use crate::fault::{Fault, Text};
use crate::formula::Formula;
use crate::kind::{Denoise, Finds, Memory, Param, Role};
use crate::scan::Item;
use crate::words::nearest;

/// Maximum number of repetitions of a function.
const REPEAT_LIMIT: u32 = 4096;

/// Names of the annotations of a function, except the annotations of its type.
const OF_FUNCTIONS: [&str; 12] = [
    "shared", "pass", "with", "repeat", "texel", "points", "denoise", "surveys", "rays", "finds", "reach", "turn",
];

/// Annotations of the function itself.
#[derive(Clone, Debug, Default)]
pub(super) struct FunctionAnnotations {
    pub(super) doc: String,
    /// Place of `@vector`, if the result is a vector.
    pub(super) vector: Option<Range<usize>>,
    /// Place of `@shared`.
    pub(super) shared: Option<Range<usize>>,
    pub(super) pass: Option<(u32, Range<usize>)>,
    pub(super) repeat: Option<(Formula, Range<usize>)>,
    pub(super) texel: Option<(Formula, Range<usize>)>,
    pub(super) points: Option<(Formula, Range<usize>)>,
    /// Index of the parameter with the number of rays.
    pub(super) rays: Option<(usize, Range<usize>)>,
    pub(super) finds: Finds,
    /// Index of the parameter that limits rays.
    pub(super) reach: Option<(usize, Range<usize>)>,
    /// Index of the angle; a hit counts only if the surface turns by more than half of it.
    pub(super) turn: Option<(usize, Range<usize>)>,
    /// Name of the surveyed input, and of the parameter that chooses its groups.
    pub(super) surveys: Option<(String, Range<usize>)>,
    /// Name of the input that a pass exists for.
    pub(super) with: Option<(String, Range<usize>)>,
    /// Method to denoise a mean over rays.
    pub(super) denoise: Option<(Denoise, Range<usize>)>,
}

impl FunctionAnnotations {
    /// Returns true if no annotation concerns a pass, a ray, a survey, or the type of a port.
    pub(super) fn is_free(&self) -> bool {
        self.pass.is_none()
            && self.repeat.is_none()
            && self.texel.is_none()
            && self.points.is_none()
            && self.rays.is_none()
            && self.reach.is_none()
            && self.turn.is_none()
            && self.surveys.is_none()
            && self.with.is_none()
            && self.denoise.is_none()
            && self.vector.is_none()
    }
}

/// Reads the comment above a function.
pub(super) fn read_annotations(
    text: Text<'_>,
    item: &Item,
    params: &[Param],
    faults: &mut Vec<Fault>,
) -> (FunctionAnnotations, Vec<InputAnnotations>) {
    let comment = DocComment::read(&item.docs);
    let mut read = FunctionAnnotations {
        doc: comment.prose(),
        ..FunctionAnnotations::default()
    };
    let mut inputs: Vec<InputAnnotations> = Vec::new();
    comment.check(text, FUNCTION_ANNOTATIONS, &OF_FUNCTIONS, faults);
    for annotation in comment
        .annotations
        .iter()
        .filter(|annotation| FUNCTION_ANNOTATIONS.contains(&annotation.name.as_str()))
    {
        match (annotation.name.as_str(), inputs.last_mut()) {
            ("input", _) => inputs.extend(InputAnnotations::begin(text, annotation, faults)),
            ("shared", _) => read.shared = Some(annotation.whole()),
            ("pass", _) => read.pass = pass_number(text, annotation, faults),
            ("repeat", _) => read.repeat = repeat(text, annotation, params, faults),
            ("texel", _) => read.texel = formula(text, annotation, params, faults),
            ("points", _) => read.points = formula(text, annotation, params, faults),
            ("rays", _) => read.rays = rays(text, annotation, params, faults),
            ("finds", _) => read.finds = finds(text, annotation, faults),
            ("reach", _) => read.reach = reach(text, annotation, params, faults),
            ("turn", _) => read.turn = turn(text, annotation, params, faults),
            ("surveys", _) => read.surveys = Some((annotation.joined(), annotation.whole())),
            ("with", _) => read.with = Some((annotation.joined(), annotation.whole())),
            ("denoise", _) => read.denoise = denoise(text, annotation, faults),
            (_, Some(input)) => input.add(text, annotation, faults),
            ("vector", None) => read.vector = Some(annotation.range.clone()),
            _ => {
                let mut fault = unknown_annotation(
                    text,
                    annotation,
                    &[
                        "input", "shared", "pass", "with", "repeat", "texel", "points", "denoise", "surveys", "rays",
                        "finds", "reach", "turn", "vector",
                    ],
                );
                fault.advice = format!("`@{}` belongs behind the `@input` that it is about.", annotation.name);
                faults.push(fault);
            }
        }
    }
    if read.doc.is_empty() {
        faults.push(not_described(text, item, &read));
    }
    (read, inputs)
}

fn not_described(text: Text<'_>, item: &Item, read: &FunctionAnnotations) -> Fault {
    let what = if read.shared.is_some() {
        "shared function"
    } else {
        "output"
    };
    text.fault(
        item.name_range.clone(),
        format!("The {what} `{}` is not described.", item.name),
        "Say in the first `///` line above it what it gives.",
    )
}

fn pass_number(text: Text<'_>, annotation: &Annotation, faults: &mut Vec<Fault>) -> Option<(u32, Range<usize>)> {
    match annotation.joined().parse::<u32>() {
        Ok(number) if number > 0 => Some((number, annotation.whole())),
        _ => {
            faults.push(text.fault(
                annotation.whole(),
                "`@pass` takes one whole number from 1 on.",
                "Write `@pass 1` for the function that runs first.",
            ));
            None
        }
    }
}

/// Reads `@repeat N`, `@repeat params.steps`, or a formula.
fn repeat(
    text: Text<'_>,
    annotation: &Annotation,
    params: &[Param],
    faults: &mut Vec<Fault>,
) -> Option<(Formula, Range<usize>)> {
    let (read, range) = formula(text, annotation, params, faults)?;
    let mut refuse = |(message, advice): (String, String)| {
        faults.push(text.fault(annotation.whole(), message, advice));
        None
    };
    match read {
        Formula::Number(times) if times.fract() != 0.0 || !(1.0..=f64::from(REPEAT_LIMIT)).contains(&times) => {
            refuse((
                format!("`@repeat` takes a whole number from 1 to {REPEAT_LIMIT}, a parameter, or a formula."),
                "Write `@repeat 8`, `@repeat params.steps` or `@repeat ceil(params.radius / texel)`.".to_owned(),
            ))
        }
        Formula::Param(index) => {
            match count_param("repeat", &params[index].name, params, "how often the function runs") {
                Ok(_) => Some((read, range)),
                Err(told) => refuse(told),
            }
        }
        _ => Some((read, range)),
    }
}

/// Reads the formula of `@repeat`, `@texel` or `@points`.
fn formula(
    text: Text<'_>,
    annotation: &Annotation,
    params: &[Param],
    faults: &mut Vec<Fault>,
) -> Option<(Formula, Range<usize>)> {
    accepted(text, annotation, read_formula(&annotation.joined(), params), faults)
}

/// Returns the value of an annotation with its range. Reports a fault with this message and advice if there is none.
fn accepted<T>(
    text: Text<'_>,
    annotation: &Annotation,
    read: Result<T, (String, String)>,
    faults: &mut Vec<Fault>,
) -> Option<(T, Range<usize>)> {
    match read {
        Ok(value) => Some((value, annotation.whole())),
        Err((message, advice)) => {
            faults.push(text.fault(annotation.whole(), message, advice));
            None
        }
    }
}

/// Reads `@rays params.rays`.
fn rays(
    text: Text<'_>,
    annotation: &Annotation,
    params: &[Param],
    faults: &mut Vec<Fault>,
) -> Option<(usize, Range<usize>)> {
    let written = annotation.joined();
    let name = written.strip_prefix("params.");
    let index = match name {
        Some(name) => count_param("rays", name, params, "how many rays there are"),
        None => Err((
            "`@rays` takes a parameter.".to_owned(),
            "Write `@rays params.rays`.".to_owned(),
        )),
    };
    accepted(text, annotation, index, faults)
}

/// Reads `@reach params.distance`.
fn reach(
    text: Text<'_>,
    annotation: &Annotation,
    params: &[Param],
    faults: &mut Vec<Fault>,
) -> Option<(usize, Range<usize>)> {
    let index = param_of_role(annotation, params, Role::Length).ok_or_else(|| {
        (
            "`@reach` takes a parameter that is a `@length`.".to_owned(),
            "Write `@reach params.distance` where rays go as far as that length, or less, and nothing else of them \
             depends on it."
                .to_owned(),
        )
    });
    accepted(text, annotation, index, faults)
}

/// Reads `@turn params.angle`.
fn turn(
    text: Text<'_>,
    annotation: &Annotation,
    params: &[Param],
    faults: &mut Vec<Fault>,
) -> Option<(usize, Range<usize>)> {
    let index = param_of_role(annotation, params, Role::Angle).ok_or_else(|| {
        (
            "`@turn` takes a parameter that is an `@angle`.".to_owned(),
            "Write `@turn params.angle` where hits count for nothing on triangles that turn by less than half that angle \
             against the one that the ray starts on."
                .to_owned(),
        )
    });
    accepted(text, annotation, index, faults)
}

/// Returns the index of the parameter with this role that an annotation names, if it is a single number.
fn param_of_role(annotation: &Annotation, params: &[Param], role: Role) -> Option<usize> {
    let written = annotation.joined();
    let name = written.strip_prefix("params.")?;
    let is_it = |param: &Param| param.name == name && param.ty.role == role && param.ty.memory == Memory::F32;
    params.iter().position(is_it)
}

/// Reads `@finds any` or `@finds nearest`.
fn finds(text: Text<'_>, annotation: &Annotation, faults: &mut Vec<Fault>) -> Finds {
    match annotation.joined().as_str() {
        "any" => return Finds::Any,
        "nearest" => {}
        _ => faults.push(text.fault(
            annotation.whole(),
            "`@finds` takes `any` or `nearest`.",
            "Write `@finds any` where it only matters whether something is hit.",
        )),
    }
    Finds::Nearest
}

/// Reads `@denoise triangles` or `@denoise shading`.
fn denoise(text: Text<'_>, annotation: &Annotation, faults: &mut Vec<Fault>) -> Option<(Denoise, Range<usize>)> {
    let read = match annotation.joined().as_str() {
        "triangles" => Ok(Denoise::Triangles),
        "shading" => Ok(Denoise::Shading),
        _ => Err((
            "`@denoise` takes `triangles` or `shading`.".to_owned(),
            "Write `@denoise triangles` for what changes at every edge of the model, and `@denoise shading` for what an edge \
             with smooth shading does not show in."
                .to_owned(),
        )),
    };
    accepted(text, annotation, read, faults)
}

/// Returns the index of the parameter with this name, which must be able to count; `what` describes the count. The error
/// consists of message and advice.
fn count_param(annotation: &str, name: &str, params: &[Param], what: &str) -> Result<usize, (String, String)> {
    let Some(index) = params.iter().position(|param| param.name == name) else {
        let advice = match nearest(name, params.iter().map(|param| param.name.as_str())) {
            Some(meant) => format!("Did you mean `params.{meant}`?"),
            None => "Name a member of `struct Params`.".to_owned(),
        };
        let message = format!("`@{annotation}` names a parameter `{name}`, which does not exist.");
        return Err((message, advice));
    };
    let ty = &params[index].ty;
    let is_bounded = ty
        .range
        .is_some_and(|[low, high]| low >= 1.0 && high <= f64::from(REPEAT_LIMIT));
    if ty.memory != Memory::U32 || ty.role != Role::Plain || !is_bounded {
        return Err((
            format!("`params.{name}` cannot say {what}."),
            format!("Make it a `u32` with a `@range` from 1 to at most {REPEAT_LIMIT}."),
        ));
    }
    Ok(index)
}
