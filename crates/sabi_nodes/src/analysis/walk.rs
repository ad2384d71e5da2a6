//! Visitors of naga's statements and expressions.

use std::collections::BTreeMap;

use naga::{
    Block, Expression, Function, Handle, ImageQuery, Literal, LocalVariable, Module, SampleLevel, Span, Statement,
};

/// Returns all expressions of a function with their places in the text.
pub(crate) fn expressions_with_spans(function: &Function) -> impl Iterator<Item = (&Expression, Span)> {
    function
        .expressions
        .iter()
        .map(|(handle, expression)| (expression, function.expressions.get_span(handle)))
}

/// Calls `see` for every statement, including nested ones.
pub(crate) fn visit<'m>(block: &'m Block, see: &mut impl FnMut(&'m Statement, Span)) {
    for (statement, span) in block.span_iter() {
        see(statement, *span);
        for nested in nested_blocks(statement) {
            visit(nested, see);
        }
    }
}

/// Blocks inside a statement.
pub(crate) fn nested_blocks(statement: &Statement) -> Vec<&Block> {
    match statement {
        Statement::Block(block) => vec![block],
        Statement::If { accept, reject, .. } => vec![accept, reject],
        Statement::Switch { cases, .. } => cases.iter().map(|case| &case.body).collect(),
        Statement::Loop { body, continuing, .. } => vec![body, continuing],
        _ => Vec::new(),
    }
}

/// Calls `see` for every direct operand of `expression`.
pub(crate) fn children(expression: &Expression, see: &mut impl FnMut(Handle<Expression>)) {
    let mut all = |handles: &[Option<Handle<Expression>>]| handles.iter().flatten().for_each(|handle| see(*handle));
    match expression {
        Expression::Compose { components, .. } => components.iter().for_each(|component| all(&[Some(*component)])),
        Expression::Access { base, index } => all(&[Some(*base), Some(*index)]),
        Expression::AccessIndex { base, .. } => all(&[Some(*base)]),
        Expression::Splat { value, .. } => all(&[Some(*value)]),
        Expression::Swizzle { vector, .. } => all(&[Some(*vector)]),
        Expression::Load { pointer } => all(&[Some(*pointer)]),
        Expression::ImageSample {
            image,
            sampler,
            coordinate,
            array_index,
            offset,
            level,
            depth_ref,
            ..
        } => {
            all(&[Some(*image), Some(*sampler), Some(*coordinate)]);
            all(&[*array_index, *offset, *depth_ref]);
            all(&level_parts(level));
        }
        Expression::ImageLoad {
            image,
            coordinate,
            array_index,
            sample,
            level,
        } => all(&[Some(*image), Some(*coordinate), *array_index, *sample, *level]),
        Expression::ImageQuery { image, query } => {
            let level = match query {
                ImageQuery::Size { level } => *level,
                _ => None,
            };
            all(&[Some(*image), level]);
        }
        Expression::Unary { expr, .. }
        | Expression::Derivative { expr, .. }
        | Expression::As { expr, .. }
        | Expression::ArrayLength(expr) => all(&[Some(*expr)]),
        Expression::Relational { argument, .. } => all(&[Some(*argument)]),
        Expression::Binary { left, right, .. } => all(&[Some(*left), Some(*right)]),
        Expression::Select {
            condition,
            accept,
            reject,
        } => all(&[Some(*condition), Some(*accept), Some(*reject)]),
        Expression::Math {
            arg, arg1, arg2, arg3, ..
        } => all(&[Some(*arg), *arg1, *arg2, *arg3]),
        // Literals and other leaves, and expressions that the rules refuse.
        _ => {}
    }
}

fn level_parts(level: &SampleLevel) -> [Option<Handle<Expression>>; 2] {
    match level {
        SampleLevel::Exact(level) | SampleLevel::Bias(level) => [Some(*level), None],
        SampleLevel::Gradient { x, y } => [Some(*x), Some(*y)],
        SampleLevel::Auto | SampleLevel::Zero => [None, None],
    }
}

/// An assignment to a local variable or a part of it.
#[derive(Clone, Debug)]
pub(crate) struct Store {
    pub(crate) local: Handle<LocalVariable>,
    /// Indices that lead from the variable to the part; `None` where an index is computed at run time.
    pub(crate) path: Vec<Option<u32>>,
    /// The pointer to that part.
    pub(crate) pointer: Handle<Expression>,
    /// Stored value; `None` where a called function writes through a pointer.
    pub(crate) value: Option<Handle<Expression>>,
    /// Conditions around it, the outermost first, with the side taken.
    pub(crate) conditions: Vec<(Handle<Expression>, bool)>,
}

/// Returns the variable that a pointer points into, and the path to the part.
pub(crate) fn target(
    function: &Function,
    mut pointer: Handle<Expression>,
) -> Option<(Handle<LocalVariable>, Vec<Option<u32>>)> {
    let mut path = Vec::new();
    loop {
        match function.expressions[pointer] {
            Expression::LocalVariable(local) => {
                path.reverse();
                return Some((local, path));
            }
            Expression::AccessIndex { base, index } => {
                path.push(Some(index));
                pointer = base;
            }
            Expression::Access { base, .. } => {
                path.push(None);
                pointer = base;
            }
            _ => return None,
        }
    }
}

/// All assignments to local variables in a block.
pub(crate) fn stores(function: &Function, block: &Block) -> Vec<Store> {
    let mut found = Vec::new();
    gather_stores(function, block, &mut Vec::new(), &mut found);
    found
}

fn gather_stores(
    function: &Function,
    block: &Block,
    conditions: &mut Vec<(Handle<Expression>, bool)>,
    found: &mut Vec<Store>,
) {
    for statement in block {
        let written: Vec<(Handle<Expression>, Option<Handle<Expression>>)> = match statement {
            Statement::Store { pointer, value } => vec![(*pointer, Some(*value))],
            Statement::Call { arguments, .. } => arguments.iter().map(|argument| (*argument, None)).collect(),
            _ => Vec::new(),
        };
        for (pointer, value) in written {
            if let Some((local, path)) = target(function, pointer) {
                found.push(Store {
                    local,
                    path,
                    pointer,
                    value,
                    conditions: conditions.clone(),
                });
            }
        }
        if let Statement::If {
            condition,
            accept,
            reject,
        } = statement
        {
            for (side, taken) in [(accept, true), (reject, false)] {
                conditions.push((*condition, taken));
                gather_stores(function, side, conditions, found);
                conditions.pop();
            }
        } else {
            for nested in nested_blocks(statement) {
                gather_stores(function, nested, conditions, found);
            }
        }
    }
}

/// Returns conditions that all hold if `condition` holds. naga turns `a && b` into an unnamed variable that is `b` inside
/// `if a`, and false otherwise.
pub(crate) fn conjuncts(
    function: &Function,
    stores: &[Store],
    condition: Handle<Expression>,
) -> Vec<Handle<Expression>> {
    let mut found = Vec::new();
    let mut open = vec![condition];
    while let Some(condition) = open.pop() {
        match and_parts(function, stores, condition) {
            // A chain of `&&` is no longer than the text. The limit only guards against changes in naga.
            Some(parts) if found.len() + open.len() < 256 => open.extend(parts),
            _ => found.push(condition),
        }
    }
    found
}

fn and_parts(function: &Function, stores: &[Store], condition: Handle<Expression>) -> Option<[Handle<Expression>; 2]> {
    let Expression::Load { pointer } = function.expressions[condition] else {
        return None;
    };
    let Expression::LocalVariable(local) = function.expressions[pointer] else {
        return None;
    };
    if function.local_variables[local].name.is_some() {
        return None;
    }
    let mut parts = None;
    for store in stores.iter().filter(|store| store.local == local) {
        let value = store.value?;
        if matches!(function.expressions[value], Expression::Literal(Literal::Bool(false))) {
            continue;
        }
        match (store.conditions.last(), parts) {
            (Some(&(first, true)), None) => parts = Some([first, value]),
            _ => return None,
        }
    }
    parts
}

/// Function and arguments of calls, by the index of their `CallResult`.
pub(crate) type Calls = BTreeMap<usize, (Handle<Function>, Vec<Handle<Expression>>)>;

/// Maps each `CallResult` to the call that produces it.
pub(crate) fn calls(block: &Block) -> Calls {
    let mut calls = BTreeMap::new();
    visit(block, &mut |statement, _| {
        if let Statement::Call {
            function,
            arguments,
            result: Some(result),
        } = statement
        {
            calls.insert(result.index(), (*function, arguments.clone()));
        }
    });
    calls
}

/// A returned value, and the conditions around it with the side taken.
pub(crate) type Returned = (Handle<Expression>, Vec<(Handle<Expression>, bool)>);

/// Lists all values that a function returns.
pub(crate) fn returns(block: &Block) -> Vec<Returned> {
    let mut found = Vec::new();
    gather_returns(block, &mut Vec::new(), &mut found);
    found
}

fn gather_returns(block: &Block, conditions: &mut Vec<(Handle<Expression>, bool)>, found: &mut Vec<Returned>) {
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

/// Returns true if an expression is a literal zero.
pub(crate) fn is_zero(module: &Module, function: &Function, expression: Handle<Expression>, depth: u32) -> bool {
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
