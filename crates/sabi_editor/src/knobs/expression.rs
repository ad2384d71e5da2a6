//! Sums that are typed where a number is expected: `2*0.3`, `sqrt(2)`, `pi/4`, `3.4 cm`, and `*=2` for what is there.

#[cfg(test)]
mod tests;

use std::f64::consts;

/// Deepest nesting of parentheses and signs, which bounds the stack.
const DEEPEST: u32 = 64;

/// Units that can follow a number, and the unit of angles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Units<'u> {
    /// Names, and the factor to the unit of the knob.
    pub(super) named: &'u [(&'static str, f64)],
    /// Radians in one of the angles that `sin`, `cos` and `tan` take.
    pub(super) angle: f64,
}

impl Units<'_> {
    /// Plain numbers; angles in radians.
    pub(super) const NONE: Units<'static> = Units { named: &[], angle: 1.0 };
    /// Angles in degrees, as knobs of angles hold them.
    pub(super) const DEGREES: Units<'static> = Units {
        named: &[("deg", 1.0), ("°", 1.0), ("rad", 180.0 / consts::PI)],
        angle: consts::PI / 180.0,
    };
}

/// What is wrong with a sum, and at which character, counted from 1.
#[derive(Debug, PartialEq)]
struct ExpressionError {
    at: usize,
    what: String,
}

/// Value of an expression. `present` is the number that `+=`, `-=`, `*=` and `/=` start from, if there is one.
///
/// The error is a sentence.
pub(super) fn evaluate(text: &str, present: Option<f64>, units: Units<'_>) -> Result<f64, String> {
    let text = text.trim();
    let relative = ["+=", "-=", "*=", "/="].iter().find(|sign| text.starts_with(**sign));
    // Spreadsheets have one in front of expressions.
    let skipped = relative.map_or(usize::from(text.starts_with('=')), |sign| sign.len());
    let number = Reader::new(text, skipped, units)
        .whole()
        .map_err(|mistake| format!("{} (character {}).", mistake.what, mistake.at))?;
    let result = match (relative, present) {
        (None, _) => number,
        (Some(_), None) => {
            return Err(
                "The selected nodes differ here, so there is no one number to start from: type it whole.".into(),
            );
        }
        (Some(sign), Some(present)) => match *sign {
            "+=" => present + number,
            "-=" => present - number,
            "*=" => present * number,
            _ => present / number,
        },
    };
    if result.is_finite() {
        Ok(result)
    } else {
        Err("This has no finite result: something is divided by zero, or is too large, or has no root.".to_owned())
    }
}

/// Reads a text from left to right.
struct Reader<'t> {
    letters: Vec<char>,
    at: usize,
    depth: u32,
    units: Units<'t>,
}

impl<'t> Reader<'t> {
    fn new(text: &str, at: usize, units: Units<'t>) -> Reader<'t> {
        // A minus as word processors set it means the same.
        let letters = text.chars().map(|letter| if letter == '−' { '-' } else { letter });
        Reader {
            letters: letters.collect(),
            at,
            depth: 0,
            units,
        }
    }

    fn whole(mut self) -> Result<f64, ExpressionError> {
        let number = self.sum()?;
        match self.peek() {
            None => Ok(number),
            Some(',') => Err(self.mistake("Decimals are written with a point, as in 0.5")),
            Some(')') => Err(self.mistake("This `)` closes nothing")),
            Some(letter) => Err(self.mistake(format!("`{letter}` cannot stand here"))),
        }
    }

    fn sum(&mut self) -> Result<f64, ExpressionError> {
        let mut sum = self.product()?;
        loop {
            match self.peek() {
                Some('+') => sum += self.after_sign(Reader::product)?,
                Some('-') => sum -= self.after_sign(Reader::product)?,
                _ => return Ok(sum),
            }
        }
    }

    /// A unit is that of all in front of it: 1/2 cm is half a centimeter.
    fn product(&mut self) -> Result<f64, ExpressionError> {
        let mut product = self.signed()?;
        let mut has_unit = false;
        loop {
            match self.peek() {
                Some('*' | '×') => product *= self.after_sign(Reader::signed)?,
                Some('/' | '÷') => product /= self.after_sign(Reader::signed)?,
                Some('%') => product %= self.after_sign(Reader::signed)?,
                Some(letter) if !has_unit && (letter.is_alphabetic() || letter == '°') => {
                    product *= self.unit()?;
                    has_unit = true;
                }
                _ => return Ok(product),
            }
        }
    }

    fn unit(&mut self) -> Result<f64, ExpressionError> {
        let begin = self.at;
        let word = self.word();
        let unit = self.units.named.iter().find(|(name, _)| *name == word);
        unit.map(|(_, factor)| *factor).ok_or_else(|| ExpressionError {
            at: begin + 1,
            what: match self.units.named {
                [] => format!("`{word}` cannot stand here: this number has no unit"),
                named => format!("`{word}` is none of the units {}", names(named)),
            },
        })
    }

    /// A sign binds less than a power: -2^2 is -4.
    fn signed(&mut self) -> Result<f64, ExpressionError> {
        match self.peek() {
            Some('-') => self.deeper(|reader| Ok(-reader.after_sign(Reader::signed)?)),
            Some('+') => self.deeper(|reader| reader.after_sign(Reader::signed)),
            _ => self.power(),
        }
    }

    /// From right to left: 2^3^2 is 2^9.
    fn power(&mut self) -> Result<f64, ExpressionError> {
        let base = self.single()?;
        match self.peek() {
            Some('^') => self.deeper(|reader| Ok(base.powf(reader.after_sign(Reader::signed)?))),
            _ => Ok(base),
        }
    }

    fn single(&mut self) -> Result<f64, ExpressionError> {
        match self.peek() {
            None => Err(self.mistake("A number is missing")),
            Some('(') => self.within_parentheses(),
            Some(letter) if letter.is_ascii_digit() || letter == '.' => self.number(),
            Some(letter) if letter.is_alphabetic() => self.named(),
            Some(letter) => Err(self.mistake(format!("`{letter}` stands where a number is missing"))),
        }
    }

    fn within_parentheses(&mut self) -> Result<f64, ExpressionError> {
        let opened = self.at;
        let inside = self.deeper(|reader| reader.after_sign(Reader::sum))?;
        self.close(opened)?;
        Ok(inside)
    }

    fn close(&mut self, opened: usize) -> Result<(), ExpressionError> {
        match self.peek() {
            Some(')') => {
                self.at += 1;
                Ok(())
            }
            Some(',') => Err(self.mistake("This `,` separates nothing: decimals are written with a point")),
            Some(letter) => Err(self.mistake(format!("`{letter}` cannot stand here"))),
            None => Err(ExpressionError {
                at: opened + 1,
                what: "This `(` is not closed".to_owned(),
            }),
        }
    }

    fn number(&mut self) -> Result<f64, ExpressionError> {
        let begin = self.at;
        self.take_while(|letter| letter.is_ascii_digit() || letter == '.');
        // An exponent, unless the e begins a word.
        if matches!(self.letters.get(self.at), Some('e' | 'E')) {
            let signed = usize::from(matches!(self.letters.get(self.at + 1), Some('+' | '-')));
            if self.letters.get(self.at + 1 + signed).is_some_and(char::is_ascii_digit) {
                self.at += 1 + signed;
                self.take_while(|letter| letter.is_ascii_digit());
            }
        }
        let text: String = self.letters[begin..self.at].iter().collect();
        text.parse().map_err(|_| ExpressionError {
            at: begin + 1,
            what: format!("`{text}` is not a number"),
        })
    }

    /// A constant, or a function with what it is asked of.
    fn named(&mut self) -> Result<f64, ExpressionError> {
        let begin = self.at;
        let name = self.word();
        let constant = match name.as_str() {
            "pi" | "π" => Some(consts::PI),
            "tau" => Some(consts::TAU),
            "e" => Some(consts::E),
            _ => None,
        };
        if let Some(constant) = constant {
            return Ok(constant);
        }
        let unknown = || ExpressionError {
            at: begin + 1,
            what: format!("`{name}` is not known here: there are pi, tau, e, {FUNCTIONS}"),
        };
        if self.peek() != Some('(') {
            return Err(unknown());
        }
        let opened = self.at;
        let given = self.deeper(Reader::list)?;
        self.close(opened)?;
        apply(&name, &given, self.units.angle).unwrap_or_else(|takes| match takes {
            Some(takes) => Err(ExpressionError {
                at: begin + 1,
                what: format!("`{name}` takes {takes}"),
            }),
            None => Err(unknown()),
        })
    }

    fn list(&mut self) -> Result<Vec<f64>, ExpressionError> {
        let mut given = vec![self.after_sign(Reader::sum)?];
        while self.peek() == Some(',') {
            given.push(self.after_sign(Reader::sum)?);
        }
        Ok(given)
    }

    /// Rest of the text after the current character.
    fn after_sign<T>(
        &mut self,
        read: impl FnOnce(&mut Self) -> Result<T, ExpressionError>,
    ) -> Result<T, ExpressionError> {
        self.at += 1;
        read(self)
    }

    fn deeper<T>(&mut self, read: impl FnOnce(&mut Self) -> Result<T, ExpressionError>) -> Result<T, ExpressionError> {
        self.depth += 1;
        if self.depth > DEEPEST {
            return Err(self.mistake(format!(
                "No more than {DEEPEST} signs and parentheses fit within one another"
            )));
        }
        let result = read(self)?;
        self.depth -= 1;
        Ok(result)
    }

    /// The next letter that is no blank.
    fn peek(&mut self) -> Option<char> {
        let at = self.skip_blanks();
        self.letters.get(at).copied()
    }

    fn skip_blanks(&mut self) -> usize {
        self.take_while(char::is_whitespace);
        self.at
    }

    fn take_while(&mut self, fits: impl Fn(char) -> bool) {
        while self.letters.get(self.at).is_some_and(|letter| fits(*letter)) {
            self.at += 1;
        }
    }

    fn word(&mut self) -> String {
        let begin = self.at;
        self.take_while(|letter| letter.is_alphabetic() || letter == '°');
        self.letters[begin..self.at].iter().collect()
    }

    fn mistake(&self, what: impl Into<String>) -> ExpressionError {
        ExpressionError {
            at: self.at + 1,
            what: what.into(),
        }
    }
}

const FUNCTIONS: &str = "sin, cos, tan, sqrt, abs, floor, ceil, round, min, max and pow";

/// Value of a function. The error is what it takes, or `None` where there is no such function.
fn apply(name: &str, given: &[f64], angle: f64) -> Result<Result<f64, ExpressionError>, Option<&'static str>> {
    let one = || match given {
        [one] => Ok(*one),
        _ => Err(Some("one number")),
    };
    let result = match name {
        "sin" => (one()? * angle).sin(),
        "cos" => (one()? * angle).cos(),
        "tan" => (one()? * angle).tan(),
        "sqrt" => one()?.sqrt(),
        "abs" => one()?.abs(),
        "floor" => one()?.floor(),
        "ceil" => one()?.ceil(),
        "round" => one()?.round(),
        "min" => given.iter().copied().fold(f64::INFINITY, f64::min),
        "max" => given.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        "pow" => match given {
            [base, exponent] => base.powf(*exponent),
            _ => return Err(Some("two numbers")),
        },
        _ => return Err(None),
    };
    Ok(Ok(result))
}

fn names(units: &[(&'static str, f64)]) -> String {
    let names: Vec<&str> = units.iter().map(|(name, _)| *name).collect();
    names.join(", ")
}
