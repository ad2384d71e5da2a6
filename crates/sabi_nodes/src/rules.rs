//! Rules for nodes: statements and declarations that are not allowed in them.

mod sizes;

use naga::{Expression, Function, Handle, Module, SampleLevel, Span, Statement, Type, TypeInner};

use crate::analysis::walk::{expressions_with_spans, visit};
use crate::fault::{FAULTS_SHOWN, Fault, Text};
use crate::link::LinkedModule;
use crate::params::params_type;
use crate::ports::function;
use crate::scan::{ItemKind, Scan};

/// Directives. They are refused because they would have to come first in the linked kernel.
const DIRECTIVES: [&str; 3] = ["enable", "requires", "diagnostic"];

/// Checks that naga attached exactly those doc comments that the scanner read.
pub(crate) fn check_docs(text: Text<'_>, scan: &Scan, module: &Module, faults: &mut Vec<Fault>) {
    let empty = naga::DocComments::default();
    let docs = module.doc_comments.as_deref().unwrap_or(&empty);
    let mut check = |range: std::ops::Range<usize>, read: usize, attached: usize| {
        if read != attached {
            faults.push(text.fault(
                range,
                "The doc comment above this does not reach the compiler.",
                "Let its `///` lines stand directly above it, with nothing between or before them.",
            ));
        }
    };
    if scan.header.len() != docs.module.len() {
        check(0..3, scan.header.len(), docs.module.len());
    }
    for item in scan.functions() {
        let attached = function(module, &item.name).and_then(|(handle, _)| docs.functions.get(&handle));
        check(item.name_range.clone(), item.docs.len(), attached.map_or(0, Vec::len));
    }
    if let (Some(item), Some((handle, _))) = (scan.params(), params_type(module)) {
        for (index, member) in item.members.iter().enumerate() {
            let attached = docs.struct_members.get(&(handle, index));
            check(
                member.name_range.clone(),
                member.docs.len(),
                attached.map_or(0, Vec::len),
            );
        }
    }
}

/// Checks the rules that need only the module.
pub(crate) fn check_module(linked: &LinkedModule, scan: &Scan, module: &Module, faults: &mut Vec<Fault>) {
    for item in scan.items.iter().filter(|item| item.kind == ItemKind::Other) {
        if let Some(keyword) = linked.wgsl().get(item.keyword.clone())
            && DIRECTIVES.contains(&keyword)
        {
            let span = Span::from(item.keyword.clone());
            let advice = "Remove it: a node is linked with others, and these lines hold for all of them.";
            faults.push(linked.fault(span, format!("A node cannot say `{keyword}`."), advice));
        }
    }
    for entry in &module.entry_points {
        let place = scan.functions().find(|item| item.name == entry.name);
        let span = place.map_or(Span::UNDEFINED, |item| Span::from(item.name_range.clone()));
        faults.push(linked.fault(
            span,
            format!("A node has no entry points, and `{}` is one.", entry.name),
            "Remove the attributes in front of `fn`; the kernel around the node is written for you.",
        ));
    }
    for (handle, _) in module.overrides.iter() {
        faults.push(linked.fault(
            module.overrides.get_span(handle),
            "A node has no `override`.",
            "Make it a member of `struct Params`, or a `const`.",
        ));
    }
    for (handle, variable) in module.global_variables.iter() {
        let span = module.global_variables.get_span(handle);
        if !linked.is_privileged(span) {
            faults.push(linked.fault(
                span,
                format!(
                    "A node has no variables outside of functions, and `{}` is one.",
                    variable.name.as_deref().unwrap_or("this")
                ),
                "Use a `const`, a parameter, an input, or a local `var`.",
            ));
        }
    }
    if faults.is_empty() {
        sizes::check(linked, module, faults);
        for (handle, function) in module.functions.iter() {
            check_function(linked, module.functions.get_span(handle), function, faults);
        }
        check_params_are_passed_on(linked, module, faults);
    }
}

fn check_function(linked: &LinkedModule, span: Span, function: &Function, faults: &mut Vec<Fault>) {
    let in_node = linked.is_in_node(span);
    for (expression, span) in expressions_with_spans(function) {
        let refused = match expression {
            Expression::Derivative { .. }
            | Expression::ImageSample {
                level: SampleLevel::Auto | SampleLevel::Bias(_),
                ..
            } => Some((
                "Derivatives across the screen do not exist on a surface.",
                "Use `at.texel_size` for the width of a texel, or read neighbors through lib/surface.",
            )),
            Expression::ImageSample { .. } | Expression::ImageLoad { .. } | Expression::ImageQuery { .. }
                if in_node =>
            {
                Some((
                    "A node reads a texture only through lib/surface, which knows about seams.",
                    "Add `//! @use surface` to the header and call one of its functions.",
                ))
            }
            _ => None,
        };
        let refused = refused.filter(|_| faults.len() < FAULTS_SHOWN);
        faults.extend(refused.map(|(message, advice)| linked.fault(span, message, advice)));
    }
    check_statements(linked, function, faults);
}

/// Refuses statements that have effects beyond the result for one place, and `discard`, which gives no result.
fn check_statements(linked: &LinkedModule, function: &Function, faults: &mut Vec<Fault>) {
    visit(&function.body, &mut |statement, span| {
        let what = match statement {
            Statement::Kill => "`discard`",
            Statement::ControlBarrier(_) | Statement::MemoryBarrier(_) => "barriers",
            Statement::Atomic { .. } | Statement::ImageAtomic { .. } => "atomics",
            Statement::ImageStore { .. } => "writing to textures",
            Statement::WorkGroupUniformLoad { .. } => "workgroup memory",
            Statement::RayQuery { .. } | Statement::RayPipelineFunction(_) => "ray queries",
            Statement::SubgroupBallot { .. }
            | Statement::SubgroupGather { .. }
            | Statement::SubgroupCollectiveOperation { .. }
            | Statement::CooperativeStore { .. } => "subgroups",
            _ => return,
        };
        if faults.len() >= FAULTS_SHOWN {
            return;
        }
        faults.push(linked.fault(
            span,
            format!("A node cannot use {what}."),
            "A function gives the result of one place, from that place alone; return it.",
        ));
    });
}

/// Refuses copies of the parameters: the bound of a loop in a modified copy would not be limited by the range of the parameter.
fn check_params_are_passed_on(linked: &LinkedModule, module: &Module, faults: &mut Vec<Fault>) {
    let Some((params, _)) = params_type(module) else {
        return;
    };
    let mut refuse = |span: Span| {
        faults.push(linked.fault(
            span,
            "`Params` can be read and passed on, but not copied or made.",
            "Read its members into variables of their own, or name it with `let`.",
        ));
    };
    for (handle, ty) in module.types.iter() {
        if contains(ty, params) {
            refuse(module.types.get_span(handle));
        }
    }
    for (handle, function) in module.functions.iter() {
        if function.result.as_ref().is_some_and(|result| result.ty == params) {
            refuse(module.functions.get_span(handle));
        }
        for (handle, local) in function.local_variables.iter() {
            if local.ty == params {
                refuse(function.local_variables.get_span(handle));
            }
        }
        for (expression, span) in expressions_with_spans(function) {
            if constructs(expression, params) {
                refuse(span);
            }
        }
    }
    for (handle, constant) in module.constants.iter() {
        if constant.ty == params {
            refuse(module.constants.get_span(handle));
        }
    }
}

fn contains(ty: &Type, params: Handle<Type>) -> bool {
    match &ty.inner {
        TypeInner::Struct { members, .. } => members.iter().any(|member| member.ty == params),
        TypeInner::Array { base, .. } | TypeInner::Pointer { base, .. } => *base == params,
        _ => false,
    }
}

fn constructs(expression: &Expression, params: Handle<Type>) -> bool {
    matches!(expression, Expression::Compose { ty, .. } | Expression::ZeroValue(ty) if *ty == params)
}
