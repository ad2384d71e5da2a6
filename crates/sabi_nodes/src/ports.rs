//! Reads functions: outputs, passes and inputs.

mod drafts;
mod formulas;
mod functions;
mod inputs;
mod passes;
mod rays;
mod shared_functions;
mod survey;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::ops::Range;

use naga::{Function, Handle, ImageClass, ImageDimension, Module, ScalarKind, Type, TypeInner};
use sabi_graph::PortType;

use crate::fault::{Fault, Text};
use crate::formula::Formula;
use crate::kind::{Argument, INPUT_LIMIT, Input, MATERIAL_INPUT_LIMIT, Output, Param, Pass, Rays, SharedFunction};
use crate::scan::{Item, Member, Scan};
use functions::FunctionAnnotations;
use inputs::InputAnnotations;
use shared_functions::SharedType;

/// Outputs, passes, inputs and rays of a file.
#[derive(Clone, Debug, Default)]
pub(crate) struct Ports {
    pub(crate) inputs: Vec<Input>,
    pub(crate) outputs: Vec<Output>,
    pub(crate) shared: Vec<SharedFunction>,
    /// Passes, in ascending order of their numbers.
    pub(crate) passes: Vec<Pass>,
    pub(crate) rays: Option<Rays>,
    pub(crate) surveyed: Option<usize>,
    pub(crate) survey_groups: Option<usize>,
}

/// Returns the function with this name in the file itself, not in a library.
pub(crate) fn function<'m>(module: &'m Module, name: &str) -> Option<(Handle<Function>, &'m Function)> {
    module
        .functions
        .iter()
        .find(|(_, function)| function.name.as_deref() == Some(name))
}

/// Returns the port type of a WGSL type. If `vector` is true, `vec3f` is a vector instead of a color.
fn port_type(ty: &Type, vector: bool) -> Option<PortType> {
    match &ty.inner {
        TypeInner::Scalar(naga::Scalar::F32) => Some(PortType::Mask),
        TypeInner::Vector {
            size: naga::VectorSize::Tri,
            scalar: naga::Scalar::F32,
        } => Some(if vector { PortType::Vector } else { PortType::Color }),
        TypeInner::Struct { .. } if ty.name.as_deref() == Some("Material") => Some(PortType::Material),
        _ => None,
    }
}

/// Returns true if a type is `texture_2d_array<f32>`.
fn is_field(ty: &Type) -> bool {
    matches!(
        ty.inner,
        TypeInner::Image {
            dim: ImageDimension::D2,
            arrayed: true,
            class: ImageClass::Sampled {
                kind: ScalarKind::Float,
                multi: false
            },
        }
    )
}

/// Returns true if a type is `u32`.
fn is_u32(ty: &Type) -> bool {
    matches!(ty.inner, TypeInner::Scalar(scalar) if scalar.kind == ScalarKind::Uint)
}

/// A documented function before its arguments are read.
struct FunctionDraft<'a> {
    item: &'a Item,
    function: &'a Function,
    annotations: FunctionAnnotations,
    gives: Gives,
}

/// Result type of a documented function.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Gives {
    /// A type that a port can carry.
    Port(PortType),
    /// A ray.
    Ray,
    /// Any type: the result is only used by other functions of the node.
    Shared,
}

impl FunctionDraft<'_> {
    /// Returns the port type of the result, if a port can carry it.
    fn port(&self) -> Option<PortType> {
        match self.gives {
            Gives::Port(ty) => Some(ty),
            Gives::Ray | Gives::Shared => None,
        }
    }

    fn is_ray(&self) -> bool {
        self.gives == Gives::Ray
    }
}

/// Reads all documented functions except those with faults.
pub(crate) fn read_ports(
    text: Text<'_>,
    scan: &Scan,
    module: &Module,
    params: &[Param],
    faults: &mut Vec<Fault>,
) -> Ports {
    let mut reader = PortReader {
        text,
        scan,
        module,
        params,
        faults,
        described: BTreeMap::new(),
        inputs: Vec::new(),
        pass_numbers: Vec::new(),
        shared: Vec::new(),
        has_rays: false,
        has_survey: false,
    };
    let drafts = reader.drafts();
    reader.has_rays = drafts.iter().any(FunctionDraft::is_ray);
    reader.has_survey = drafts.iter().any(survey::takes_survey);
    reader.check_passes(&drafts);
    reader.find_shared(&drafts);
    let mut ports = Ports::default();
    for draft in &drafts {
        reader.add_function(draft, &mut ports);
    }
    ports.passes.sort_by_key(|pass| pass.number);
    reader.check_rays(&drafts, &ports);
    reader.check_shared(&drafts, &ports);
    if let Some((surveyed, groups)) = reader.surveyed_input(&drafts, &ports) {
        (ports.surveyed, ports.survey_groups) = (Some(surveyed), groups);
    }
    reader.find_inputs_of_passes(&drafts, &mut ports);
    reader.check_described();
    if ports.outputs.is_empty() && reader.faults.is_empty() {
        let range = scan.functions().last().map_or(0..0, |item| item.name_range.clone());
        reader.faults.push(text.fault(
            range,
            "The node has no output.",
            "A function with a `///` comment above it is an output, and its name is the name of the port.",
        ));
    }
    ports.inputs = reader.inputs;
    ports
}

struct PortReader<'a> {
    text: Text<'a>,
    scan: &'a Scan,
    module: &'a Module,
    params: &'a [Param],
    faults: &'a mut Vec<Fault>,
    /// Annotations of `@input`, by name of the input.
    described: BTreeMap<String, InputAnnotations>,
    inputs: Vec<Input>,
    /// Names of passes in ascending order of their numbers, with number and type.
    pass_numbers: Vec<(u32, String, PortType)>,
    /// Shared functions in the order of the file.
    shared: Vec<SharedType>,
    /// True if a function returns a ray.
    has_rays: bool,
    /// True if a function takes a survey.
    has_survey: bool,
}

impl<'a> PortReader<'a> {
    fn at(&mut self, range: Range<usize>, message: impl Into<String>, advice: impl Into<String>) {
        self.faults.push(self.text.fault(range, message, advice));
    }

    /// Reads a function and adds it to the ports according to its result and annotations.
    fn add_function(&mut self, draft: &FunctionDraft<'a>, ports: &mut Ports) {
        let ty = match draft.gives {
            Gives::Port(ty) => ty,
            Gives::Ray => {
                let rays = self.rays(draft);
                ports.rays = rays.or(ports.rays.take());
                return;
            }
            Gives::Shared => {
                ports.shared.push(self.shared(draft));
                return;
            }
        };
        let function = self.output(draft, ty);
        match draft.annotations.pass {
            Some((number, _)) => ports.passes.push(Pass {
                number,
                function,
                with: None,
                denoise: draft.annotations.denoise.as_ref().map(|(denoise, _)| *denoise),
            }),
            None => ports.outputs.push(function),
        }
    }

    fn arguments(&mut self, draft: &FunctionDraft<'a>) -> Vec<Argument> {
        let mut arguments = Vec::new();
        for (member, argument) in draft.item.members.iter().zip(&draft.function.arguments) {
            if let Ok(ty) = self.module.types.get_handle(argument.ty) {
                arguments.extend(self.argument(draft, member, argument.ty, ty));
            }
        }
        arguments
    }

    fn output(&mut self, draft: &FunctionDraft<'a>, ty: PortType) -> Output {
        let arguments = self.arguments(draft);
        self.check_repeat(draft, &arguments);
        let of_rays = [
            &draft.annotations.rays,
            &draft.annotations.reach,
            &draft.annotations.turn,
        ];
        for (_, range) in of_rays.into_iter().flatten() {
            let message = format!("`{}` makes no rays.", draft.item.name);
            self.at(
                range.clone(),
                message,
                "`@rays`, `@reach` and `@turn` belong above the function `ray`.",
            );
        }
        if let (Some((_, range)), None) = (&draft.annotations.texel, &draft.annotations.pass) {
            let message = format!(
                "`{}` is a result, and results are as fine as the maps.",
                draft.item.name
            );
            self.at(
                range.clone(),
                message,
                "Let a pass run on wider texels, and read what it gives.",
            );
        }
        if let (Some((_, range)), None) = (&draft.annotations.points, &draft.annotations.texel) {
            let message = format!(
                "`{}` does not say on which texels it runs where there are no points.",
                draft.item.name
            );
            self.at(range.clone(), message, "Add `@texel` with the widest texels.");
        }
        let formula =
            |annotation: &Option<(Formula, Range<usize>)>| annotation.as_ref().map(|(formula, _)| formula.clone());
        Output {
            name: draft.item.name.clone(),
            ty,
            doc: draft.annotations.doc.clone(),
            arguments,
            repeat: formula(&draft.annotations.repeat),
            texel: formula(&draft.annotations.texel),
            points: formula(&draft.annotations.points),
            channels: Vec::new(),
        }
    }

    fn argument(
        &mut self,
        draft: &FunctionDraft<'a>,
        member: &Member,
        handle: Handle<Type>,
        ty: &Type,
    ) -> Option<Argument> {
        let name = member.name.as_str();
        match (name, ty.name.as_deref()) {
            ("at", Some("Surface")) => return Some(Argument::At),
            ("params", Some("Params")) => return Some(Argument::Params),
            ("ray", Some("Ray")) => return Some(Argument::Ray),
            ("hit", Some("Hit")) => return Some(Argument::Hit),
            ("round", Some("Round")) => return Some(Argument::Round),
            ("survey", _) if is_field(ty) => return Some(Argument::Survey),
            ("group", _) if survey::takes_survey(draft) && is_u32(ty) => return Some(Argument::Group),
            ("index", _) if draft.is_ray() => return self.ray_index(member, ty),
            ("at" | "params", _) | (_, Some("Surface" | "Params")) => {
                self.at(
                    member.name_range.start..member.type_range.end,
                    "The place is always called `at: Surface`, and the parameters `params: Params`.",
                    "Give the argument this name and type, or another of both.",
                );
                return None;
            }
            _ => {}
        }
        if let Some(index) = self.shared.iter().position(|shared| shared.name == name) {
            return self.shared_argument(draft, member, handle, index);
        }
        if let Some(index) = self.pass_numbers.iter().position(|(_, pass, _)| pass == name) {
            return self.pass_argument(draft, member, ty, index);
        }
        let known = self.inputs.iter().position(|input| input.name == name);
        let input = inputs::read_input(self, draft, member, ty)?;
        match known {
            Some(index) if self.inputs[index].ty == input.ty && self.inputs[index].reads == input.reads => {
                Some(Argument::Input(index))
            }
            Some(_) => {
                let message = format!("The input `{name}` has another type in an earlier function.");
                self.at(
                    member.type_range.clone(),
                    message,
                    "Give it the same type everywhere, or another name.",
                );
                None
            }
            None if self.inputs.len() == INPUT_LIMIT => {
                let message = format!("A node has at most {INPUT_LIMIT} inputs.");
                self.at(member.name_range.clone(), message, "Split the node in two.");
                None
            }
            None if input.ty == PortType::Material && self.material_inputs() == MATERIAL_INPUT_LIMIT => {
                let message = format!("A node has at most {MATERIAL_INPUT_LIMIT} inputs for materials.");
                self.at(member.name_range.clone(), message, "Split the node in two.");
                None
            }
            None => {
                self.inputs.push(input);
                Some(Argument::Input(self.inputs.len() - 1))
            }
        }
    }

    fn material_inputs(&self) -> usize {
        self.inputs
            .iter()
            .filter(|input| input.ty == PortType::Material)
            .count()
    }

    /// Checks that every `@input` has the name of an argument.
    fn check_described(&mut self) {
        if !self.faults.is_empty() {
            return;
        }
        let described = std::mem::take(&mut self.described);
        for (name, annotations) in described {
            if self.inputs.iter().any(|input| input.name == name) {
                continue;
            }
            let names = self.inputs.iter().map(|input| input.name.as_str());
            let advice = match crate::words::nearest(&name, names) {
                Some(meant) => format!("Did you mean `{meant}`?"),
                None => "An input is an argument of a documented function.".to_owned(),
            };
            self.at(
                annotations.range,
                format!("`@input {name}` describes no input."),
                advice,
            );
        }
    }
}
