//! Structs, constants and workgroup sizes of a linked module, as read by the shader compiler.

use std::collections::BTreeMap;

use naga::valid::Capabilities;
use naga::{Binding, Expression, Handle, Literal, Module, Type, TypeInner};

use super::LinkedModule;
use super::parse::compile;
use crate::fault::Fault;

/// Layouts and values that the Rust code must match.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reflection {
    /// Structs by name.
    pub structs: BTreeMap<String, StructLayout>,
    /// Components of constants by name. Constants that are not numbers are left out.
    pub constants: BTreeMap<String, Vec<f64>>,
    /// Workgroup sizes of compute entry points by name.
    pub workgroups: BTreeMap<String, [u32; 3]>,
    /// Names of overrides with their default values, if those are numbers.
    pub overrides: BTreeMap<String, Option<f64>>,
}

/// Memory layout of a struct.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StructLayout {
    /// Size in bytes, including padding at the end.
    pub size: u32,
    /// Members in order.
    pub members: Vec<MemberLayout>,
}

/// Memory layout of a struct's member.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MemberLayout {
    /// Name in WGSL.
    pub name: String,
    /// Bytes from the start of the struct.
    pub offset: u32,
    /// Size in bytes, without padding after it.
    pub size: u32,
    /// Location of the vertex attribute or interpolated value, if the member is one.
    pub location: Option<u32>,
}

impl LinkedModule {
    /// Compiles the module and returns its layouts and constants.
    pub fn reflect(&self) -> Result<Reflection, Fault> {
        let (module, _) = compile(self, Capabilities::all())?;
        let mut reflection = Reflection::default();
        for (_, ty) in module.types.iter() {
            if let (Some(name), Some(layout)) = (&ty.name, layout_of(&module, ty)) {
                reflection.structs.insert(name.clone(), layout);
            }
        }
        for (_, constant) in module.constants.iter() {
            let mut numbers = Vec::new();
            if let Some(name) = &constant.name
                && read_numbers(&module, constant.init, &mut numbers).is_some()
            {
                reflection.constants.insert(name.clone(), numbers);
            }
        }
        for entry in &module.entry_points {
            if entry.stage == naga::ShaderStage::Compute {
                reflection.workgroups.insert(entry.name.clone(), entry.workgroup_size);
            }
        }
        for (_, switch) in module.overrides.iter() {
            let default = switch.init.and_then(|init| {
                let mut numbers = Vec::new();
                read_numbers(&module, init, &mut numbers)?;
                numbers.first().copied()
            });
            if let Some(name) = &switch.name {
                reflection.overrides.insert(name.clone(), default);
            }
        }
        Ok(reflection)
    }
}

fn layout_of(module: &Module, ty: &Type) -> Option<StructLayout> {
    let TypeInner::Struct { members, span } = &ty.inner else {
        return None;
    };
    let layout = |member: &naga::StructMember| {
        Some(MemberLayout {
            name: member.name.clone()?,
            offset: member.offset,
            size: module.types[member.ty].inner.size(module.to_ctx()),
            location: match member.binding {
                Some(Binding::Location { location, .. }) => Some(location),
                _ => None,
            },
        })
    };
    Some(StructLayout {
        size: *span,
        members: members.iter().map(layout).collect::<Option<_>>()?,
    })
}

/// Appends the components of a constant expression; `None` if a component is not a number.
fn read_numbers(module: &Module, expression: Handle<Expression>, numbers: &mut Vec<f64>) -> Option<()> {
    match &module.global_expressions[expression] {
        Expression::Literal(literal) => numbers.push(match *literal {
            Literal::F32(value) => f64::from(value),
            Literal::F64(value) | Literal::AbstractFloat(value) => value,
            Literal::U32(value) => f64::from(value),
            Literal::I32(value) => f64::from(value),
            Literal::AbstractInt(value) => value as f64,
            _ => return None,
        }),
        Expression::Compose { components, .. } => {
            for component in components {
                read_numbers(module, *component, numbers)?;
            }
        }
        Expression::Splat { size, value } => {
            for _ in 0..*size as u32 {
                read_numbers(module, *value, numbers)?;
            }
        }
        Expression::Constant(constant) => read_numbers(module, module.constants[*constant].init, numbers)?,
        _ => return None,
    }
    Some(())
}
