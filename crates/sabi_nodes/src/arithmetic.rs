//! Arithmetic as users type it: numbers, signs, powers, functions, names and units.
//!
//! Annotations of nodes (`@repeat ceil(params.width / texel)`) and number fields of the editor (`2 * 3.4 cm`) share this
//! grammar. Each of them defines which names, functions and units exist.

#[cfg(test)]
mod tests;

/// Maximum nesting of signs and parentheses, which limits the use of the stack.
pub const DEPTH_LIMIT: u32 = 64;

/// Syntax tree of an arithmetic text. A chain of sums or products is one flat node, so the tree is only as deep as the
/// parentheses are nested.
#[derive(Clone, Debug, PartialEq)]
pub enum Expression {
    /// A number.
    Number(f64),
    /// A name that is not a function.
    Name(Word),
    /// A function with its arguments.
    Call(Word, Vec<Expression>),
    /// `-a`
    Negative(Box<Expression>),
    /// `a ^ b`
    Power(Box<[Expression; 2]>),
    /// Sums, or products, from left to right.
    Chain(Box<Expression>, Vec<(Operator, Expression)>),
    /// A number with a unit behind it.
    Measure(Box<Expression>, Word),
}

/// Operator between the parts of a chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
    /// `%`
    Remainder,
}

/// A name in the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Word {
    /// The name.
    pub text: String,
    /// Place of its first character, counted from 1.
    pub at: usize,
}

/// Names and units allowed besides numbers and signs.
#[derive(Clone, Copy, Debug)]
pub struct Syntax {
    /// True if units may follow numbers.
    pub has_units: bool,
    /// Returns true if a character may continue a name; names begin with a letter.
    pub is_in_name: fn(char) -> bool,
}

/// Syntax error in an arithmetic expression.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SyntaxError {
    /// Place of the character, counted from 1.
    pub at: usize,
    /// Kind of error.
    pub kind: SyntaxErrorKind,
}

/// Kinds of syntax errors.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum SyntaxErrorKind {
    /// The text ends where a number is missing.
    UnexpectedEnd,
    /// Something else is found where a number is expected.
    ExpectedNumber(String),
    /// Something follows a complete expression.
    TrailingText(String),
    /// Something else is found where a closing parenthesis is expected.
    ExpectedParenthesis(String),
    /// A parenthesis is not closed.
    UnclosedParenthesis,
    /// Digits and points that do not form a number.
    BadNumber(String),
    /// Signs and parentheses are nested more than [`DEPTH_LIMIT`] deep.
    TooDeep,
}

impl Expression {
    /// Reads a text, starting at the character with index `start` (counted from 0).
    pub fn read(text: &str, start: usize, syntax: Syntax) -> Result<Expression, SyntaxError> {
        // Word processors replace hyphens by minus signs.
        let letters = text.chars().map(|letter| if letter == '−' { '-' } else { letter });
        let mut reader = ExpressionReader {
            letters: letters.collect(),
            at: start,
            depth: 0,
            syntax,
        };
        let expression = reader.sum()?;
        match reader.peek() {
            None => Ok(expression),
            Some(_) => Err(reader.error_at_token(SyntaxErrorKind::TrailingText)),
        }
    }

    /// Returns the number of numbers, names and functions in the expression.
    pub fn terms(&self) -> usize {
        match self {
            Expression::Number(_) | Expression::Name(_) => 1,
            Expression::Call(_, arguments) => 1 + arguments.iter().map(Expression::terms).sum::<usize>(),
            Expression::Negative(inner) | Expression::Measure(inner, _) => inner.terms(),
            Expression::Power(both) => both.iter().map(Expression::terms).sum(),
            Expression::Chain(first, rest) => {
                first.terms() + rest.iter().map(|(_, expression)| expression.terms()).sum::<usize>()
            }
        }
    }
}

/// Reads a text from left to right.
struct ExpressionReader {
    letters: Vec<char>,
    at: usize,
    depth: u32,
    syntax: Syntax,
}

type ExpressionResult = Result<Expression, SyntaxError>;

impl ExpressionReader {
    fn sum(&mut self) -> ExpressionResult {
        let first = self.product()?;
        let mut rest = Vec::new();
        loop {
            let sign = match self.peek() {
                Some('+') => Operator::Add,
                Some('-') => Operator::Subtract,
                _ => return Ok(chain(first, rest)),
            };
            rest.push((sign, self.after_sign(ExpressionReader::product)?));
        }
    }

    /// Reads a product. A unit applies to everything in front of it: 1/2 cm is half a centimeter.
    fn product(&mut self) -> ExpressionResult {
        let mut first = self.signed()?;
        let mut rest = Vec::new();
        let mut has_unit = false;
        loop {
            let sign = match self.peek() {
                Some('*' | '×') => Operator::Multiply,
                Some('/' | '÷') => Operator::Divide,
                Some('%') => Operator::Remainder,
                Some(letter) if self.syntax.has_units && !has_unit && (letter.is_alphabetic() || letter == '°') => {
                    let unit = self.word();
                    first = Expression::Measure(Box::new(chain(first, std::mem::take(&mut rest))), unit);
                    has_unit = true;
                    continue;
                }
                _ => return Ok(chain(first, rest)),
            };
            rest.push((sign, self.after_sign(ExpressionReader::signed)?));
        }
    }

    /// Reads a term with a sign. A sign binds more loosely than a power: -2^2 is -4.
    fn signed(&mut self) -> ExpressionResult {
        match self.peek() {
            Some('-') => {
                let inner = self.deeper(|reader| reader.after_sign(ExpressionReader::signed))?;
                Ok(Expression::Negative(Box::new(inner)))
            }
            Some('+') => self.deeper(|reader| reader.after_sign(ExpressionReader::signed)),
            _ => self.power(),
        }
    }

    /// Reads a power. Powers are evaluated from right to left: 2^3^2 is 2^9.
    fn power(&mut self) -> ExpressionResult {
        let base = self.single()?;
        match self.peek() {
            Some('^') => {
                let exponent = self.deeper(|reader| reader.after_sign(ExpressionReader::signed))?;
                Ok(Expression::Power(Box::new([base, exponent])))
            }
            _ => Ok(base),
        }
    }

    fn single(&mut self) -> ExpressionResult {
        match self.peek() {
            None => Err(self.error(SyntaxErrorKind::UnexpectedEnd)),
            Some('(') => self.within_parentheses(),
            Some(letter) if letter.is_ascii_digit() || letter == '.' => self.number(),
            Some(letter) if letter.is_alphabetic() => self.named(),
            Some(_) => Err(self.error_at_token(SyntaxErrorKind::ExpectedNumber)),
        }
    }

    fn within_parentheses(&mut self) -> ExpressionResult {
        let opened = self.at;
        let inside = self.deeper(|reader| reader.after_sign(ExpressionReader::sum))?;
        self.close(opened)?;
        Ok(inside)
    }

    fn close(&mut self, opened: usize) -> Result<(), SyntaxError> {
        match self.peek() {
            Some(')') => {
                self.at += 1;
                Ok(())
            }
            Some(_) => Err(self.error_at_token(SyntaxErrorKind::ExpectedParenthesis)),
            None => Err(SyntaxError {
                at: opened + 1,
                kind: SyntaxErrorKind::UnclosedParenthesis,
            }),
        }
    }

    fn number(&mut self) -> ExpressionResult {
        let begin = self.at;
        self.take_while(|letter| letter.is_ascii_digit() || letter == '.');
        // An `e` starts an exponent, unless it is the start of a word.
        if matches!(self.letters.get(self.at), Some('e' | 'E')) {
            let signed = usize::from(matches!(self.letters.get(self.at + 1), Some('+' | '-')));
            if self.letters.get(self.at + 1 + signed).is_some_and(char::is_ascii_digit) {
                self.at += 1 + signed;
                self.take_while(|letter| letter.is_ascii_digit());
            }
        }
        let text: String = self.letters[begin..self.at].iter().collect();
        let number = text.parse().map(Expression::Number);
        number.map_err(|_| SyntaxError {
            at: begin + 1,
            kind: SyntaxErrorKind::BadNumber(text),
        })
    }

    fn named(&mut self) -> ExpressionResult {
        let name = self.word();
        if self.peek() != Some('(') {
            return Ok(Expression::Name(name));
        }
        let opened = self.at;
        let arguments = self.deeper(ExpressionReader::arguments)?;
        self.close(opened)?;
        Ok(Expression::Call(name, arguments))
    }

    fn arguments(&mut self) -> Result<Vec<Expression>, SyntaxError> {
        let mut arguments = vec![self.after_sign(ExpressionReader::sum)?];
        while self.peek() == Some(',') {
            arguments.push(self.after_sign(ExpressionReader::sum)?);
        }
        Ok(arguments)
    }

    /// Skips the sign or parenthesis at the current place, and reads what follows one level deeper.
    fn after_sign<T>(&mut self, read: impl FnOnce(&mut Self) -> Result<T, SyntaxError>) -> Result<T, SyntaxError> {
        self.at += 1;
        read(self)
    }

    fn deeper<T>(&mut self, read: impl FnOnce(&mut Self) -> Result<T, SyntaxError>) -> Result<T, SyntaxError> {
        self.depth += 1;
        if self.depth > DEPTH_LIMIT {
            return Err(self.error(SyntaxErrorKind::TooDeep));
        }
        let result = read(self)?;
        self.depth -= 1;
        Ok(result)
    }

    /// Returns the next character that is not blank.
    fn peek(&mut self) -> Option<char> {
        self.take_while(char::is_whitespace);
        self.letters.get(self.at).copied()
    }

    fn take_while(&mut self, fits: impl Fn(char) -> bool) {
        while self.letters.get(self.at).is_some_and(|letter| fits(*letter)) {
            self.at += 1;
        }
    }

    fn word(&mut self) -> Word {
        let begin = self.at;
        self.take_while(self.syntax.is_in_name);
        Word {
            text: self.letters[begin..self.at].iter().collect(),
            at: begin + 1,
        }
    }

    fn error(&self, kind: SyntaxErrorKind) -> SyntaxError {
        SyntaxError { at: self.at + 1, kind }
    }

    /// Returns an error that quotes the name, number or sign at the current place.
    fn error_at_token(&mut self, kind: fn(String) -> SyntaxErrorKind) -> SyntaxError {
        let begin = self.at;
        let is_in_name = self.syntax.is_in_name;
        self.take_while(|letter| is_in_name(letter) || letter.is_ascii_digit() || letter == '.');
        let end = self.at.max(begin + 1);
        let token: String = self.letters[begin..end].iter().collect();
        SyntaxError {
            at: begin + 1,
            kind: kind(token),
        }
    }
}

fn chain(first: Expression, rest: Vec<(Operator, Expression)>) -> Expression {
    if rest.is_empty() {
        return first;
    }
    Expression::Chain(Box::new(first), rest)
}
