//! Small formulas in annotations: how often a function runs, and how wide its texels may be.
//!
//! `@repeat ceil(1.2 * params.width / texel)` depends on a knob and on the model, so neither the shader nor the node's
//! author can write the number down; the planner works it out.

use crate::kind::{Memory, Param};
use crate::words::{list, nearest};

/// Most terms of a formula: more is no formula that a reader understands.
const TERM_LIMIT: usize = 64;

/// A formula over parameters and texel widths.
#[derive(Clone, Debug, PartialEq)]
pub enum Formula {
    /// A number.
    Number(f64),
    /// The value of a parameter, by index in [`crate::kind::Kind::params`]; lengths are working units.
    Param(usize),
    /// Width of a texel of the level that the function runs on, working units.
    Texel,
    /// Width of a texel of the finest level, working units.
    Finest,
    /// An operation on formulas.
    Operation(Operation, Vec<Formula>),
}

/// What is done with one or two numbers.
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
    /// The next whole number above.
    Ceil,
    /// Square root.
    Sqrt,
    /// Logarithm to base 2.
    Log2,
    /// Without its sign.
    Abs,
    /// The smaller one.
    Min,
    /// The larger one.
    Max,
}

/// Functions by name, with the number of their arguments.
const FUNCTIONS: [(&str, Operation, usize); 6] = [
    ("ceil", Operation::Ceil, 1),
    ("sqrt", Operation::Sqrt, 1),
    ("log2", Operation::Log2, 1),
    ("abs", Operation::Abs, 1),
    ("min", Operation::Min, 2),
    ("max", Operation::Max, 2),
];

/// What a formula depends on.
#[derive(Clone, Copy)]
pub struct Knowns<'k> {
    /// Value of a parameter.
    pub param: &'k dyn Fn(usize) -> f64,
    /// Texel width of the level at hand.
    pub texel: f64,
    /// Texel width of the finest level.
    pub finest: f64,
}

impl Formula {
    /// Its value; may be no number, as where it divides by zero.
    pub fn value(&self, knowns: &Knowns<'_>) -> f64 {
        match self {
            Formula::Number(number) => *number,
            Formula::Param(index) => (knowns.param)(*index),
            Formula::Texel => knowns.texel,
            Formula::Finest => knowns.finest,
            Formula::Operation(operation, of) => {
                let value = |index: usize| of.get(index).map_or(0.0, |formula| formula.value(knowns));
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

    /// Parameters that it depends on.
    pub fn params(&self) -> Vec<usize> {
        match self {
            Formula::Param(index) => vec![*index],
            Formula::Operation(_, of) => of.iter().flat_map(Formula::params).collect(),
            Formula::Number(_) | Formula::Texel | Formula::Finest => Vec::new(),
        }
    }

    /// Reads a formula; else what is wrong with it, and what to do.
    pub(crate) fn read(text: &str, params: &[Param]) -> Result<Formula, (String, String)> {
        let tokens = tokens(text)?;
        if tokens.len() > TERM_LIMIT {
            let message = format!("A formula has at most {TERM_LIMIT} terms.");
            return Err((message, "Make it shorter.".to_owned()));
        }
        let mut reader = Reader {
            tokens: &tokens,
            next: 0,
            params,
        };
        let formula = reader.sum()?;
        match reader.peek() {
            None => Ok(formula),
            Some(token) => Err(reader.unexpected(Some(token))),
        }
    }
}

/// Numbers, names and signs.
fn tokens(text: &str) -> Result<Vec<String>, (String, String)> {
    let mut tokens: Vec<String> = Vec::new();
    let mut joins = false;
    for letter in text.chars() {
        let is_word = letter.is_ascii_alphanumeric() || letter == '_' || letter == '.';
        match tokens.last_mut() {
            _ if letter.is_whitespace() => joins = false,
            Some(last) if is_word && joins => last.push(letter),
            _ if is_word || "+-*/(),".contains(letter) => {
                tokens.push(letter.to_string());
                joins = is_word;
            }
            _ => {
                let message = format!("A formula cannot hold `{letter}`.");
                return Err((
                    message,
                    "It is made of numbers, names, `+ - * /`, brackets and commas.".to_owned(),
                ));
            }
        }
    }
    Ok(tokens)
}

/// Reads sums of products; brackets are the only recursion, and there are fewer of them than tokens.
struct Reader<'t> {
    tokens: &'t [String],
    next: usize,
    params: &'t [Param],
}

type Read = Result<Formula, (String, String)>;

impl<'t> Reader<'t> {
    fn peek(&self) -> Option<&'t str> {
        self.tokens.get(self.next).map(String::as_str)
    }

    fn take(&mut self, token: &str) -> bool {
        let is_it = self.peek() == Some(token);
        self.next += usize::from(is_it);
        is_it
    }

    fn expect(&mut self, token: &str) -> Result<(), (String, String)> {
        if self.take(token) {
            return Ok(());
        }
        Err((
            format!("The formula lacks a `{token}`."),
            "Close every bracket, and give each function its arguments.".to_owned(),
        ))
    }

    fn unexpected(&self, token: Option<&str>) -> (String, String) {
        let message = match token {
            Some(token) => format!("`{token}` does not fit into the formula."),
            None => "The formula ends too early.".to_owned(),
        };
        (message, "Write it like `ceil(2 * params.radius / texel)`.".to_owned())
    }

    fn sum(&mut self) -> Read {
        let mut left = self.product()?;
        loop {
            let operation = if self.take("+") {
                Operation::Add
            } else if self.take("-") {
                Operation::Subtract
            } else {
                return Ok(left);
            };
            left = Formula::Operation(operation, vec![left, self.product()?]);
        }
    }

    fn product(&mut self) -> Read {
        let mut left = self.term()?;
        loop {
            let operation = if self.take("*") {
                Operation::Multiply
            } else if self.take("/") {
                Operation::Divide
            } else {
                return Ok(left);
            };
            left = Formula::Operation(operation, vec![left, self.term()?]);
        }
    }

    fn term(&mut self) -> Read {
        let Some(token) = self.peek() else {
            return Err(self.unexpected(None));
        };
        self.next += 1;
        if token == "(" {
            let inside = self.sum()?;
            self.expect(")")?;
            return Ok(inside);
        }
        if token.starts_with(|c: char| c.is_ascii_digit())
            && let Ok(number) = token.parse::<f64>()
        {
            return Ok(Formula::Number(number));
        }
        match token {
            "texel" => Ok(Formula::Texel),
            "finest" => Ok(Formula::Finest),
            _ => match token.strip_prefix("params.") {
                Some(name) => self.param(name),
                None => self.call(token),
            },
        }
    }

    fn param(&self, name: &str) -> Read {
        let Some(index) = self.params.iter().position(|param| param.name == name) else {
            let advice = match nearest(name, self.params.iter().map(|param| param.name.as_str())) {
                Some(meant) => format!("Did you mean `params.{meant}`?"),
                None => "Name a member of `struct Params`.".to_owned(),
            };
            return Err((
                format!("The formula names a parameter `{name}`, which does not exist."),
                advice,
            ));
        };
        match self.params[index].ty.memory {
            Memory::F32 | Memory::U32 | Memory::I32 => Ok(Formula::Param(index)),
            _ => Err((
                format!("`params.{name}` is no single number."),
                "A formula takes parameters of the types `f32`, `u32` and `i32`.".to_owned(),
            )),
        }
    }

    fn call(&mut self, name: &str) -> Read {
        let Some((_, operation, count)) = FUNCTIONS.iter().find(|(known, ..)| *known == name) else {
            if !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
                return Err(self.unexpected(Some(name)));
            }
            let known = || FUNCTIONS.iter().map(|(known, ..)| *known).chain(["texel", "finest"]);
            let advice = match nearest(name, known()) {
                Some(meant) => format!("Did you mean `{meant}`?"),
                None => format!("It knows {}, and parameters as `params.name`.", list(known())),
            };
            return Err((format!("The formula does not know `{name}`."), advice));
        };
        self.expect("(")?;
        let mut of = vec![self.sum()?];
        for _ in 1..*count {
            self.expect(",")?;
            of.push(self.sum()?);
        }
        self.expect(")")?;
        Ok(Formula::Operation(*operation, of))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(text: &str) -> f64 {
        let knowns = Knowns {
            param: &|_| 0.0,
            texel: 0.5,
            finest: 0.25,
        };
        Formula::read(text, &[]).unwrap().value(&knowns)
    }

    #[test]
    fn products_bind_tighter_than_sums_and_both_go_from_left_to_right() {
        assert_eq!(value("1 + 2 * 3 - 4 / 2 - 1"), 4.0);
        assert_eq!(value("(1 + 2) * 3"), 9.0);
        assert_eq!(value("ceil(3 / texel + 0.1)"), 7.0);
        assert_eq!(
            value("max(texel / finest, min(1, 9)) + sqrt(16) + log2(8) + abs(1 - 3)"),
            11.0
        );
    }

    #[test]
    fn what_is_no_formula_is_told() {
        let why = |text: &str| Formula::read(text, &[]).unwrap_err();
        assert_eq!(why("1 +").0, "The formula ends too early.");
        assert_eq!(why("1 2").0, "`2` does not fit into the formula.");
        assert_eq!(why("(1").0, "The formula lacks a `)`.");
        assert_eq!(why("max(1)").0, "The formula lacks a `,`.");
        assert_eq!(why("2 ^ 3").0, "A formula cannot hold `^`.");
        assert_eq!(why("tezel").1, "Did you mean `texel`?");
        assert_eq!(
            why("params.size").0,
            "The formula names a parameter `size`, which does not exist."
        );
        assert_eq!(why(&"(".repeat(100)).0, "A formula has at most 64 terms.");
    }
}
