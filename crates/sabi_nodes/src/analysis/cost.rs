//! Size of a node's code with all calls expanded, as an estimate of the time to compile it.

use std::collections::HashMap;

use naga::valid::ModuleInfo;
use naga::{
    AddressSpace, ArraySize, BinaryOperator, Block, Expression, Function, Handle, MathFunction, Module, ScalarKind,
    Span, Statement, TypeInner,
};

use super::walk::{nested_blocks, visit};
use crate::fault::Fault;
use crate::kind::Cost;
use crate::link::LinkedModule;

/// Maximum cost of a node, over all its functions. Code of this cost takes llvmpipe on one core 0.2 to 19 s and at most 300
/// MiB to compile, measured with chains of every function.
const COST_LIMIT: u32 = 1 << 15;

/// Cost of a branch: a condition, a case of a `switch`, a loop.
const BRANCH: u32 = 4;

/// Costs of the functions of a module.
pub(super) struct Costs<'a> {
    linked: &'a LinkedModule,
    module: &'a Module,
    of_functions: HashMap<Handle<Function>, Cost>,
}

impl<'a> Costs<'a> {
    pub(super) fn new(linked: &'a LinkedModule, module: &'a Module, types: &ModuleInfo) -> Costs<'a> {
        let mut costs = Costs {
            linked,
            module,
            of_functions: HashMap::with_capacity(module.functions.len()),
        };
        // naga lists callees before their callers.
        for (handle, function) in module.functions.iter() {
            let types = &types[handle];
            let type_of = |expression: Handle<Expression>| types[expression].ty.inner_with(&module.types);
            let copied = |at: Handle<Expression>| size(module, &function.expressions[at], type_of(at), &type_of);
            let weigh =
                |at: Handle<Expression>| copied(at).max(weight(&function.expressions[at], type_of(at), &type_of));
            let evaluated = function.expressions.iter().map(|(at, _)| weigh(at));
            let mut cost = Cost {
                all: evaluated.fold(0, u32::saturating_add),
                straight: costs.straight(&function.body, &weigh, &copied),
            };
            visit(&function.body, &mut |statement, _| {
                let own = costs.of_statement(statement, &copied).all;
                cost.all = cost.all.saturating_add(own);
            });
            costs.of_functions.insert(handle, cost);
        }
        costs
    }

    /// Returns the cost of the code of a block outside of loops.
    fn straight(
        &self,
        block: &Block,
        weigh: &impl Fn(Handle<Expression>) -> u32,
        copied: &impl Fn(Handle<Expression>) -> u32,
    ) -> u32 {
        let costs = block.iter().map(|statement| {
            let own = self.of_statement(statement, copied).straight;
            let inside = match statement {
                Statement::Emit(range) => range.clone().map(weigh).fold(0, u32::saturating_add),
                Statement::Loop { .. } => 0,
                _ => {
                    let nested = nested_blocks(statement).into_iter();
                    nested
                        .map(|block| self.straight(block, weigh, copied))
                        .fold(0, u32::saturating_add)
                }
            };
            own.saturating_add(inside)
        });
        costs.fold(0, u32::saturating_add)
    }

    /// Returns the cost of a statement without its expressions and without the blocks in it.
    fn of_statement(&self, statement: &Statement, copied: &impl Fn(Handle<Expression>) -> u32) -> Cost {
        let own = match statement {
            Statement::Call { function, .. } => return self.of([*function]),
            Statement::If { .. } | Statement::Loop { .. } => BRANCH,
            Statement::Switch { cases, .. } => BRANCH.saturating_mul(cases.len() as u32),
            Statement::Store { value, .. } => copied(*value),
            _ => 0,
        };
        Cost {
            all: own,
            straight: own,
        }
    }

    /// Returns the cost of evaluating all of `roots` once.
    pub(super) fn of(&self, roots: impl IntoIterator<Item = Handle<Function>>) -> Cost {
        let costs = roots.into_iter().filter_map(|root| self.of_functions.get(&root));
        costs.fold(Cost::default(), |sum, cost| sum.and(*cost))
    }

    /// Refuses functions that a driver would take too long to compile.
    pub(super) fn check(&self, roots: &[Handle<Function>]) -> Result<(), Fault> {
        let all = self.of(roots.iter().copied()).all;
        if all <= COST_LIMIT {
            return Ok(());
        }
        let largest = roots.iter().max_by_key(|root| self.of([**root]).all);
        let span = largest.map_or(Span::UNDEFINED, |root| self.module.functions.get_span(*root));
        Err(self.linked.fault(
            span,
            format!("The code is too long: with all calls written out it costs as much as {all} additions; {COST_LIMIT} are allowed."),
            "Call long functions in a loop, or at fewer places. Exponentials, powers, angles and divisions of whole numbers cost as much as 8 to 40 additions.",
        ))
    }
}

/// Returns the number of groups of four numbers that an expression copies or selects one from.
fn size<'t>(
    module: &Module,
    expression: &Expression,
    ty: &TypeInner,
    type_of: &impl Fn(Handle<Expression>) -> &'t TypeInner,
) -> u32 {
    let fours = |ty: &TypeInner| match ty {
        TypeInner::Scalar(_)
        | TypeInner::Vector { .. }
        | TypeInner::Matrix { .. }
        | TypeInner::Array { .. }
        | TypeInner::Struct { .. } => ty.size(module.to_ctx()).div_ceil(16),
        _ => 1,
    };
    let base = match expression {
        Expression::Access { base, .. } => match *type_of(*base) {
            // For a computed index, a driver compiles a binary search: it selects one half of the elements, and again one
            // half of each half.
            TypeInner::Pointer {
                base,
                space: AddressSpace::Function,
            } => match module.types[base].inner {
                TypeInner::Array {
                    size: ArraySize::Constant(elements),
                    ..
                } => elements.get().div_ceil(2),
                _ => BRANCH,
            },
            // An array that is not in a variable is first stored as a whole, and then a computed index selects one of its elements.
            ref value => fours(value),
        },
        _ => 1,
    };
    fours(ty).max(base).max(1)
}

/// Returns the number of additions that take a software driver as long to compile as this operation, measured with Mesa's
/// llvmpipe on chains of a thousand operations. Compile time grows faster than the length of the code, so the weights are
/// above those measured for short chains.
fn weight<'t>(expression: &Expression, ty: &TypeInner, type_of: &impl Fn(Handle<Expression>) -> &'t TypeInner) -> u32 {
    match *expression {
        Expression::ImageLoad { .. } | Expression::ImageSample { .. } => 16,
        Expression::Unary { .. } | Expression::Select { .. } | Expression::As { .. } => numbers(ty),
        Expression::Binary { op, left, right } => numbers(ty) * binary_weight(op, type_of(left), type_of(right)),
        // The result of a determinant is one number, computed from many.
        Expression::Math { fun, arg, .. } => numbers(ty).max(numbers(type_of(arg))) * math_weight(fun),
        _ => 1,
    }
}

fn binary_weight(op: BinaryOperator, left: &TypeInner, right: &TypeInner) -> u32 {
    use BinaryOperator::{Divide, Modulo, Multiply};
    match (op, left, right) {
        (Multiply, TypeInner::Matrix { columns, .. }, _) => *columns as u32,
        (Multiply, TypeInner::Vector { size, .. }, TypeInner::Matrix { .. }) => *size as u32,
        (Divide | Modulo, ..) if left.scalar_kind() != Some(ScalarKind::Float) => 32,
        (Modulo, ..) => 2,
        _ => 1,
    }
}

fn math_weight(function: MathFunction) -> u32 {
    use MathFunction as F;
    match function {
        F::Atan2 => 40,
        F::Atan => 24,
        F::Tan => 20,
        F::Pow | F::Tanh | F::Asinh | F::Acosh | F::Atanh => 16,
        F::Sin | F::Cos | F::Sinh | F::Cosh | F::Asin | F::Acos | F::Log | F::Log2 => 12,
        F::Dot4I8Packed | F::Dot4U8Packed => 12,
        F::Exp | F::Exp2 | F::Inverse => 8,
        F::Determinant | F::SmoothStep | F::Modf | F::Frexp | F::Refract => 4,
        _ => 2,
    }
}

/// Returns how many numbers a value in registers consists of.
fn numbers(ty: &TypeInner) -> u32 {
    match *ty {
        TypeInner::Vector { size, .. } => size as u32,
        TypeInner::Matrix { columns, rows, .. } => columns as u32 * rows as u32,
        _ => 1,
    }
}
