//! Formulas in annotations: how often a function runs, and how wide its texels may be.
//!
//! A formula such as `@repeat ceil(1.2 * params.width / texel)` depends on a parameter and on the model, so it is evaluated
//! by the planner.

/// A formula over parameters and texel widths.
#[derive(Clone, Debug, PartialEq)]
pub enum Formula {
    /// A number.
    Number(f64),
    /// The value of a parameter, by index in [`crate::kind::Kind::params`]; lengths are working units.
    Param(usize),
    /// Width of a texel of the level on which the function runs, in working units.
    Texel,
    /// Width of a texel of the finest level, working units.
    Finest,
    /// An operation on formulas.
    Operation(Operation, Vec<Formula>),
}

/// Operation on one or two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// a + b
    Add,
    /// a - b
    Subtract,
    /// a * b
    Multiply,
    /// a / b
    Divide,
    /// Smallest whole number that is not less.
    Ceil,
    /// Square root.
    Sqrt,
    /// Logarithm to base 2.
    Log2,
    /// Absolute value.
    Abs,
    /// Smaller of two numbers.
    Min,
    /// Larger of two numbers.
    Max,
}

/// Values of the variables of a formula.
#[derive(Clone, Copy)]
pub struct Variables<'k> {
    /// Value of a parameter, by its index in [`crate::kind::Kind::params`].
    pub param: &'k dyn Fn(usize) -> f64,
    /// Texel width of the level on which the function runs.
    pub texel: f64,
    /// Texel width of the finest level.
    pub finest: f64,
}

impl Formula {
    /// Evaluates the formula. The result may be NaN or infinite, for example after a division by zero.
    pub fn value(&self, variables: &Variables<'_>) -> f64 {
        match self {
            Formula::Number(number) => *number,
            Formula::Param(index) => (variables.param)(*index),
            Formula::Texel => variables.texel,
            Formula::Finest => variables.finest,
            Formula::Operation(operation, of) => {
                // When a formula is read, each operation gets as many operands as it takes.
                let value = |index: usize| of.get(index).map_or(f64::NAN, |formula| formula.value(variables));
                match operation {
                    Operation::Add => value(0) + value(1),
                    Operation::Subtract => value(0) - value(1),
                    Operation::Multiply => value(0) * value(1),
                    Operation::Divide => value(0) / value(1),
                    Operation::Ceil => value(0).ceil(),
                    Operation::Sqrt => value(0).sqrt(),
                    Operation::Log2 => value(0).log2(),
                    Operation::Abs => value(0).abs(),
                    Operation::Min => value(0).min(value(1)),
                    Operation::Max => value(0).max(value(1)),
                }
            }
        }
    }

    /// Returns the parameters that the formula depends on.
    pub fn params(&self) -> Vec<usize> {
        match self {
            Formula::Param(index) => vec![*index],
            Formula::Operation(_, of) => of.iter().flat_map(Formula::params).collect(),
            Formula::Number(_) | Formula::Texel | Formula::Finest => Vec::new(),
        }
    }
}
