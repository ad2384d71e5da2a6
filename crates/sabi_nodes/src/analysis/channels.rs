//! Which channels a function that returns a material may set, and under which toggles.
//!
//! Follows each member of the returned material back to where it comes from. A member that is only copied, mixed or
//! selected from material inputs is not set: it passes theirs on. What is not understood counts as always set.

use std::collections::{BTreeMap, BTreeSet};

use naga::{
    BinaryOperator, Block, Expression, Function, Handle, Literal, LocalVariable, MathFunction, Module, ScalarKind,
    Statement, Type, TypeInner, UnaryOperator,
};

use super::walk::{Store, calls, conjuncts, nested_blocks, stores};
use crate::kind::{Channel, ChannelWrite, Param, Role};
use crate::params::params_type;

/// Members of `Material` and their channels, by name.
const MEMBERS: [(&str, Channel); 8] = [
    ("base_color", Channel::Color),
    ("alpha", Channel::Color),
    ("roughness", Channel::Surface),
    ("metallic", Channel::Surface),
    ("occlusion", Channel::Surface),
    ("height", Channel::Height),
    ("slope", Channel::Slope),
    ("emission", Channel::Emission),
];

/// Longest way that is followed, and most expressions looked at.
const DEPTH_LIMIT: u32 = 64;
const FUEL: u32 = 1 << 16;

/// `None`: not set. `Some(toggles)`: may be set when all these toggles are on.
type Write = Option<BTreeSet<usize>>;

/// Set whatever the toggles are.
fn always() -> Write {
    Some(BTreeSet::new())
}

/// Set when either is.
fn either(a: Write, b: Write) -> Write {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.intersection(&b).copied().collect()),
        (a, b) => a.or(b),
    }
}

/// Set when both are: a product with zero stays zero.
fn both(a: Write, b: Write) -> Write {
    a.zip(b).map(|(a, b)| a.union(&b).copied().collect())
}

/// What a function may set, by member of `Material`.
type Writes = Vec<Write>;

/// The channels that the material function `root` sets; empty for other functions.
pub(super) fn channels(module: &Module, params: &[Param], root: Handle<Function>) -> Vec<ChannelWrite> {
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
        channels: (0..members.len()).map(member_channel).collect(),
        plain: module
            .functions
            .iter()
            .find(|(_, function)| function.name.as_deref() == Some("plain_material"))
            .map(|(handle, _)| handle),
        fuel: FUEL,
    };
    let arguments = vec![vec![None; members.len()]; module.functions[root].arguments.len()];
    let writes = reader.function(root, arguments, DEPTH_LIMIT);
    Channel::ALL
        .into_iter()
        .filter_map(|channel| {
            let of_channel = writes
                .iter()
                .zip(&reader.channels)
                .filter(|(_, of)| **of == Some(channel));
            let write = of_channel.fold(None, |known, (write, _)| either(known, write.clone()));
            write.map(|toggles| ChannelWrite {
                channel,
                unless_off: toggles.into_iter().collect(),
            })
        })
        .collect()
}

struct Reader<'m> {
    module: &'m Module,
    params: &'m [Param],
    params_type: Option<Handle<Type>>,
    material: Handle<Type>,
    /// By member.
    channels: Vec<Option<Channel>>,
    plain: Option<Handle<Function>>,
    fuel: u32,
}

struct Frame<'m> {
    function: &'m Function,
    /// By argument; of use for materials only.
    arguments: Vec<Writes>,
    stores: Vec<Store>,
    calls: BTreeMap<usize, (Handle<Function>, Vec<Handle<Expression>>)>,
    /// Variables that are being looked at.
    open: Vec<Handle<LocalVariable>>,
}

impl<'m> Reader<'m> {
    fn all_set(&self) -> Writes {
        vec![always(); self.channels.len()]
    }

    fn none_set(&self) -> Writes {
        vec![None; self.channels.len()]
    }

    /// Whether the plain material is zero in this member.
    fn is_zero_when_plain(&self, member: usize) -> bool {
        matches!(
            self.channels.get(member),
            Some(Some(Channel::Height | Channel::Slope | Channel::Emission))
        )
    }

    fn burn(&mut self) -> bool {
        self.fuel = self.fuel.saturating_sub(1);
        self.fuel > 0
    }

    fn function(&mut self, handle: Handle<Function>, arguments: Vec<Writes>, depth: u32) -> Writes {
        if Some(handle) == self.plain {
            return self.none_set();
        }
        let Some(depth) = depth.checked_sub(1) else {
            return self.all_set();
        };
        let function = &self.module.functions[handle];
        let mut frame = Frame {
            function,
            arguments,
            stores: stores(function, &function.body),
            calls: calls(&function.body),
            open: Vec::new(),
        };
        let mut returned = Vec::new();
        gather_returns(&function.body, &mut Vec::new(), &mut returned);
        let mut writes = self.none_set();
        for (value, conditions) in returned {
            let of = self.material(&mut frame, value, depth);
            let toggles = self.toggles(&frame, &conditions);
            join(&mut writes, of, &toggles);
        }
        writes
    }

    /// What an expression that is a material sets.
    fn material(&mut self, frame: &mut Frame<'m>, expression: Handle<Expression>, depth: u32) -> Writes {
        let (Some(depth), true) = (depth.checked_sub(1), self.burn()) else {
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
                let arguments = frame
                    .calls
                    .get(&expression.index())
                    .map(|(_, arguments)| arguments.clone());
                let arguments = arguments.unwrap_or_default();
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

    /// A material of zeros differs from the plain one in some members.
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

    /// Whether storing `expression` in `member` sets it.
    fn value(&mut self, frame: &mut Frame<'m>, expression: Handle<Expression>, member: usize, depth: u32) -> Write {
        let (Some(depth), true) = (depth.checked_sub(1), self.burn()) else {
            return always();
        };
        let zero_is_plain = self.is_zero_when_plain(member);
        if zero_is_plain && is_zero(self.module, frame.function, expression, depth) {
            return None;
        }
        match frame.function.expressions[expression] {
            Expression::AccessIndex { base, index } if index as usize == member => self
                .material(frame, base, depth)
                .into_iter()
                .nth(member)
                .unwrap_or(always()),
            Expression::Load { pointer } => match frame.function.expressions[pointer] {
                Expression::LocalVariable(local) => self.value_local(frame, local, member, depth),
                Expression::AccessIndex { base, index } if index as usize == member => {
                    match frame.function.expressions[base] {
                        Expression::LocalVariable(local)
                            if frame.function.local_variables[local].ty == self.material =>
                        {
                            self.material_local(frame, local, depth)
                                .into_iter()
                                .nth(member)
                                .unwrap_or(always())
                        }
                        _ => always(),
                    }
                }
                _ => always(),
            },
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
            Expression::Math {
                fun: MathFunction::Mix,
                arg,
                arg1: Some(other),
                ..
            } => either(
                self.value(frame, arg, member, depth),
                self.value(frame, other, member, depth),
            ),
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

    /// A variable of its own that ends in a member.
    fn value_local(&mut self, frame: &mut Frame<'m>, local: Handle<LocalVariable>, member: usize, depth: u32) -> Write {
        if frame.open.contains(&local) {
            return None;
        }
        frame.open.push(local);
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

    /// Toggles that are on when the conditions come out as told.
    fn toggles(&self, frame: &Frame<'m>, conditions: &[(Handle<Expression>, bool)]) -> BTreeSet<usize> {
        let mut found = BTreeSet::new();
        for &(condition, taken) in conditions {
            let parts = if taken {
                conjuncts(frame.function, &frame.stores, condition)
            } else {
                vec![condition]
            };
            found.extend(parts.into_iter().filter_map(|part| self.toggle(frame, part, taken)));
        }
        found
    }

    /// The toggle that is on when `condition` comes out as `taken`.
    fn toggle(&self, frame: &Frame<'m>, condition: Handle<Expression>, taken: bool) -> Option<usize> {
        let (op, left, right) = match frame.function.expressions[condition] {
            Expression::Unary {
                op: UnaryOperator::LogicalNot,
                expr,
            } => {
                // One level: nobody writes more, and a text can nest deep.
                return match frame.function.expressions[expr] {
                    Expression::Unary { .. } => None,
                    _ => self.toggle(frame, expr, !taken),
                };
            }
            Expression::As {
                expr,
                kind: ScalarKind::Bool,
                ..
            } if taken => return self.toggle_param(frame, expr),
            Expression::Binary { op, left, right } => (op, left, right),
            _ => return None,
        };
        let number = |side| match frame.function.expressions[side] {
            Expression::Literal(Literal::U32(number)) => Some(number),
            _ => None,
        };
        let (param, number, swapped) = match (number(left), number(right)) {
            (None, Some(number)) => (left, number, false),
            (Some(number), None) => (right, number, true),
            _ => return None,
        };
        let is_on = match (op, number, taken) {
            (BinaryOperator::NotEqual, 0, true) | (BinaryOperator::Equal, 1, true) => true,
            (BinaryOperator::Equal, 0, false) | (BinaryOperator::NotEqual, 1, false) => true,
            (BinaryOperator::Greater, 0, true) | (BinaryOperator::LessEqual, 0, false) => !swapped,
            (BinaryOperator::GreaterEqual, 1, true) | (BinaryOperator::Less, 1, false) => !swapped,
            (BinaryOperator::Less, 0, true) | (BinaryOperator::LessEqual, 1, true) => swapped,
            _ => false,
        };
        if is_on { self.toggle_param(frame, param) } else { None }
    }

    fn toggle_param(&self, frame: &Frame<'m>, expression: Handle<Expression>) -> Option<usize> {
        let Expression::AccessIndex { base, index } = frame.function.expressions[expression] else {
            return None;
        };
        let Expression::FunctionArgument(argument) = frame.function.expressions[base] else {
            return None;
        };
        let ty = frame.function.arguments.get(argument as usize)?.ty;
        let index = index as usize;
        let is_toggle = self.params.get(index)?.role == Role::Toggle;
        (Some(ty) == self.params_type && is_toggle).then_some(index)
    }
}

fn join(writes: &mut Writes, others: Writes, toggles: &BTreeSet<usize>) {
    for (write, other) in writes.iter_mut().zip(others) {
        *write = either(write.take(), other.map(|other| &other | toggles));
    }
}

/// Whether an expression is zero by what is written.
fn is_zero(module: &Module, function: &Function, expression: Handle<Expression>, depth: u32) -> bool {
    let Some(depth) = depth.checked_sub(1) else {
        return false;
    };
    match &function.expressions[expression] {
        Expression::Literal(Literal::F32(number)) => *number == 0.0,
        Expression::ZeroValue(_) => true,
        Expression::Splat { value, .. } => is_zero(module, function, *value, depth),
        Expression::Compose { components, .. } => {
            components.len() <= 4 && components.iter().all(|part| is_zero(module, function, *part, depth))
        }
        Expression::Constant(constant) => matches!(
            module.global_expressions[module.constants[*constant].init],
            Expression::ZeroValue(_) | Expression::Literal(Literal::F32(0.0))
        ),
        _ => false,
    }
}

/// All values that a function returns, with the conditions around.
fn gather_returns(
    block: &Block,
    conditions: &mut Vec<(Handle<Expression>, bool)>,
    found: &mut Vec<(Handle<Expression>, Vec<(Handle<Expression>, bool)>)>,
) {
    for statement in block {
        match statement {
            Statement::Return { value: Some(value) } => found.push((*value, conditions.clone())),
            Statement::If {
                condition,
                accept,
                reject,
            } => {
                for (side, taken) in [(accept, true), (reject, false)] {
                    conditions.push((*condition, taken));
                    gather_returns(side, conditions, found);
                    conditions.pop();
                }
            }
            _ => nested_blocks(statement)
                .into_iter()
                .for_each(|nested| gather_returns(nested, conditions, found)),
        }
    }
}
