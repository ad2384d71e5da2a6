//! Channels that a function that returns a material can set, and the conditions under which it does.
//!
//! The analysis traces each member of the returned material back to its origin. A member that is only copied, mixed or selected from
//! material inputs is passed on, which does not count as set. Code that the analysis cannot follow counts as always set.

mod math;
mod needs;

use std::collections::BTreeSet;

use naga::{BinaryOperator, Expression, Function, Handle, LocalVariable, Module, Type, TypeInner, UnaryOperator};

use self::needs::{Write, Writes, always, both, channel_write, either, join, without_stronger};
use super::walk::{Calls, Store, calls, is_zero, returns, stores};
use crate::kind::{Argument, Channel, ChannelWrite, Param};
use crate::params::params_type;

/// Members of `Material` and their channels, by name.
const MEMBERS: [(&str, Channel); 15] = [
    ("base_color", Channel::Color),
    ("alpha", Channel::Color),
    ("roughness", Channel::Surface),
    ("metallic", Channel::Surface),
    ("occlusion", Channel::Surface),
    ("height", Channel::Height),
    ("slope", Channel::Slope),
    ("emission", Channel::Emission),
    ("coat", Channel::Coat),
    ("coat_roughness", Channel::Coat),
    ("anisotropy", Channel::Anisotropy),
    ("sheen", Channel::Sheen),
    ("sheen_roughness", Channel::Sheen),
    ("subsurface", Channel::Subsurface),
    ("transmission", Channel::Subsurface),
];

/// Maximum length of a path through expressions, and maximum number of expressions visited.
const DEPTH_LIMIT: u32 = 64;
const FUEL: u32 = 1 << 16;
/// Maximum number of expressions and assignments that are searched.
const SCAN_FUEL: u64 = 1 << 22;

/// Returns the channels that the material function `root` sets; none for functions with other results.
pub(super) fn channels(
    module: &Module,
    params: &[Param],
    root: Handle<Function>,
    inputs: &[Argument],
) -> Vec<ChannelWrite> {
    let Some((
        material,
        Type {
            inner: TypeInner::Struct { members, .. },
            ..
        },
    )) = module
        .types
        .iter()
        .find(|(_, ty)| ty.name.as_deref() == Some("Material"))
    else {
        return Vec::new();
    };
    if module.functions[root].result.as_ref().map(|result| result.ty) != Some(material) {
        return Vec::new();
    }
    let member_channel = |index: usize| {
        let name = members.get(index).and_then(|member| member.name.as_deref());
        MEMBERS
            .iter()
            .find(|(known, _)| Some(*known) == name)
            .map(|(_, channel)| *channel)
    };
    let mut reader = Reader {
        module,
        params,
        params_type: params_type(module).map(|(handle, _)| handle),
        material,
        root,
        inputs,
        channels: (0..members.len()).map(member_channel).collect(),
        plain: module
            .functions
            .iter()
            .find(|(_, function)| function.name.as_deref() == Some("plain_material"))
            .map(|(handle, _)| handle),
        fuel: FUEL,
        scan_fuel: SCAN_FUEL,
    };
    let arguments = vec![vec![None; members.len()]; module.functions[root].arguments.len()];
    let writes = reader.function(root, arguments, DEPTH_LIMIT);
    let of_channel = |channel| {
        let members = writes.iter().zip(&reader.channels);
        let of_channel = members.filter(move |(_, of)| **of == Some(channel));
        let written: Vec<_> = of_channel.filter_map(|(write, _)| write.clone()).collect();
        without_stronger(&written)
            .map(move |needs| channel_write(channel, needs))
            .collect::<Vec<_>>()
    };
    Channel::ALL.into_iter().flat_map(of_channel).collect()
}

struct Reader<'m> {
    module: &'m Module,
    params: &'m [Param],
    params_type: Option<Handle<Type>>,
    material: Handle<Type>,
    root: Handle<Function>,
    /// Bindings of the arguments of `root`, in order.
    inputs: &'m [Argument],
    /// Channel of each member of `Material`.
    channels: Vec<Option<Channel>>,
    plain: Option<Handle<Function>>,
    fuel: u32,
    scan_fuel: u64,
}

struct Frame<'m> {
    function: &'m Function,
    /// Writes for each argument; used only for arguments that are materials.
    arguments: Vec<Writes>,
    stores: Vec<Store>,
    calls: Calls,
    /// Variables that are being analyzed.
    open: Vec<Handle<LocalVariable>>,
}

impl<'m> Reader<'m> {
    fn all_set(&self) -> Writes {
        vec![always(); self.channels.len()]
    }

    fn none_set(&self) -> Writes {
        vec![None; self.channels.len()]
    }

    /// Returns true if the plain material is zero in this member.
    fn is_zero_when_plain(&self, member: usize) -> bool {
        let channel = self.channels.get(member).copied().flatten();
        channel.is_some_and(|channel| !matches!(channel, Channel::Color | Channel::Surface))
    }

    /// Takes fuel for searching this many parts of a function. Returns false if not enough is left.
    fn scans(&mut self, parts: usize) -> bool {
        self.scan_fuel = self.scan_fuel.saturating_sub(parts as u64);
        self.scan_fuel > 0
    }

    fn use_fuel(&mut self) -> bool {
        self.fuel = self.fuel.saturating_sub(1);
        self.fuel > 0 && self.scan_fuel > 0
    }

    fn function(&mut self, handle: Handle<Function>, arguments: Vec<Writes>, depth: u32) -> Writes {
        if Some(handle) == self.plain {
            return self.none_set();
        }
        let Some(depth) = depth.checked_sub(1) else {
            return self.all_set();
        };
        let function = &self.module.functions[handle];
        if !self.scans(function.expressions.len()) {
            return self.all_set();
        }
        let mut frame = Frame {
            function,
            arguments,
            stores: stores(function, &function.body),
            calls: calls(&function.body),
            open: Vec::new(),
        };
        let mut writes = self.none_set();
        for (value, conditions) in returns(&function.body) {
            let of = self.material(&mut frame, value, depth);
            let toggles = self.toggles(&frame, &conditions);
            join(&mut writes, of, &toggles);
        }
        writes
    }

    /// Returns the conditions under which an expression of type material sets each member.
    fn material(&mut self, frame: &mut Frame<'m>, expression: Handle<Expression>, depth: u32) -> Writes {
        let (Some(depth), true) = (depth.checked_sub(1), self.use_fuel()) else {
            return self.all_set();
        };
        match &frame.function.expressions[expression] {
            Expression::FunctionArgument(index) => {
                let is_material = |argument: &naga::FunctionArgument| argument.ty == self.material;
                match (
                    frame.function.arguments.get(*index as usize),
                    frame.arguments.get(*index as usize),
                ) {
                    (Some(argument), Some(writes)) if is_material(argument) => writes.clone(),
                    _ => self.all_set(),
                }
            }
            Expression::Load { pointer } => match frame.function.expressions[*pointer] {
                Expression::LocalVariable(local) if frame.function.local_variables[local].ty == self.material => {
                    self.material_local(frame, local, depth)
                }
                _ => self.all_set(),
            },
            Expression::CallResult(callee) => {
                let Some((_, arguments)) = frame.calls.get(&expression.index()).cloned() else {
                    return self.all_set();
                };
                let of_callee = &self.module.functions[*callee].arguments;
                let of_arguments = arguments.iter().zip(of_callee).map(|(argument, declared)| {
                    if declared.ty == self.material {
                        self.material(frame, *argument, depth)
                    } else {
                        self.all_set()
                    }
                });
                let of_arguments = of_arguments.collect();
                self.function(*callee, of_arguments, depth)
            }
            Expression::Compose { ty, components } if *ty == self.material => {
                let parts = components.iter().enumerate();
                parts
                    .map(|(member, part)| self.value(frame, *part, member, depth))
                    .collect()
            }
            Expression::ZeroValue(ty) if *ty == self.material => self.zero(),
            _ => self.all_set(),
        }
    }

    /// Returns the writes of a material of zeros, which differs from the plain material in some members.
    fn zero(&self) -> Writes {
        let members = 0..self.channels.len();
        members
            .map(|member| {
                if self.is_zero_when_plain(member) {
                    None
                } else {
                    always()
                }
            })
            .collect()
    }

    fn material_local(&mut self, frame: &mut Frame<'m>, local: Handle<LocalVariable>, depth: u32) -> Writes {
        let mut writes = self.none_set();
        if frame.open.contains(&local) {
            return writes;
        }
        frame.open.push(local);
        self.scans(frame.stores.len());
        let own: Vec<Store> = frame
            .stores
            .iter()
            .filter(|store| store.local == local)
            .cloned()
            .collect();
        match frame.function.local_variables[local].init {
            Some(init) => join(&mut writes, self.material(frame, init, depth), &BTreeSet::new()),
            None if own.iter().any(|store| store.path.is_empty() && store.value.is_some()) => {}
            None => join(&mut writes, self.zero(), &BTreeSet::new()),
        }
        for store in own {
            let toggles = self.toggles(frame, &store.conditions);
            let of = match (store.value, store.path.as_slice()) {
                (Some(value), []) => self.material(frame, value, depth),
                (value, [Some(member), rest @ ..]) => {
                    let member = *member as usize;
                    let mut of = self.none_set();
                    if let Some(write) = of.get_mut(member) {
                        *write = match value {
                            Some(value) if rest.is_empty() => self.value(frame, value, member, depth),
                            _ => always(),
                        };
                    }
                    of
                }
                _ => self.all_set(),
            };
            join(&mut writes, of, &toggles);
        }
        frame.open.pop();
        writes
    }

    /// Returns the conditions under which storing `expression` in `member` sets it; `None` if it never does.
    fn value(&mut self, frame: &mut Frame<'m>, expression: Handle<Expression>, member: usize, depth: u32) -> Write {
        let (Some(depth), true) = (depth.checked_sub(1), self.use_fuel()) else {
            return always();
        };
        let zero_is_plain = self.is_zero_when_plain(member);
        if zero_is_plain && is_zero(self.module, frame.function, expression, depth) {
            return None;
        }
        if zero_is_plain && let Some(need) = self.need(frame, expression) {
            return Some(BTreeSet::from([need]));
        }
        match frame.function.expressions[expression] {
            Expression::AccessIndex { base, index } if index as usize == member => self
                .material(frame, base, depth)
                .into_iter()
                .nth(member)
                .unwrap_or(always()),
            Expression::Load { pointer } => self.value_behind(frame, pointer, member, depth),
            Expression::Select {
                condition,
                accept,
                reject,
            } => {
                let on = self.toggles(frame, &[(condition, true)]);
                let off = self.toggles(frame, &[(condition, false)]);
                let accept = self.value(frame, accept, member, depth).map(|toggles| &toggles | &on);
                let reject = self.value(frame, reject, member, depth).map(|toggles| &toggles | &off);
                either(accept, reject)
            }
            Expression::Math { fun, arg, arg1, .. } => self.math(fun, arg, arg1, frame, member, depth),
            Expression::Binary { op, left, right } if zero_is_plain => {
                let mut of = |side| self.value(frame, side, member, depth);
                match op {
                    BinaryOperator::Add | BinaryOperator::Subtract => either(of(left), of(right)),
                    BinaryOperator::Multiply => both(of(left), of(right)),
                    BinaryOperator::Divide => of(left),
                    _ => always(),
                }
            }
            Expression::Unary {
                op: UnaryOperator::Negate,
                expr,
            } if zero_is_plain => self.value(frame, expr, member, depth),
            _ => always(),
        }
    }

    /// Returns the conditions under which storing the value behind `pointer` in `member` sets it.
    fn value_behind(&mut self, frame: &mut Frame<'m>, pointer: Handle<Expression>, member: usize, depth: u32) -> Write {
        let function = frame.function;
        match function.expressions[pointer] {
            Expression::LocalVariable(local) => self.value_local(frame, local, member, depth),
            Expression::AccessIndex { base, index } if index as usize == member => match function.expressions[base] {
                Expression::LocalVariable(local) if function.local_variables[local].ty == self.material => {
                    let writes = self.material_local(frame, local, depth);
                    writes.into_iter().nth(member).unwrap_or(always())
                }
                _ => always(),
            },
            _ => always(),
        }
    }

    /// Returns the conditions under which storing a local variable in `member` sets it.
    fn value_local(&mut self, frame: &mut Frame<'m>, local: Handle<LocalVariable>, member: usize, depth: u32) -> Write {
        if frame.open.contains(&local) {
            return None;
        }
        frame.open.push(local);
        self.scans(frame.stores.len());
        let own: Vec<Store> = frame
            .stores
            .iter()
            .filter(|store| store.local == local)
            .cloned()
            .collect();
        let mut write = match frame.function.local_variables[local].init {
            Some(init) => self.value(frame, init, member, depth),
            None if self.is_zero_when_plain(member) || !own.is_empty() => None,
            None => always(),
        };
        for store in own {
            let toggles = self.toggles(frame, &store.conditions);
            let of = match store.value {
                Some(value) if store.path.is_empty() => self.value(frame, value, member, depth),
                _ => always(),
            };
            write = either(write, of.map(|of| &of | &toggles));
        }
        frame.open.pop();
        write
    }
}
