//! Declarations of a text, with the names that they use and how deeply they nest.
//!
//! Brackets, template lists, statements and operators are followed as in the compiler, so that the depth counted here is at
//! least the depth of the compiler's syntax tree. A text that is not WGSL is read up to the place where naga refuses it.

use std::ops::Range;

use super::DEPTH_LIMIT;
use crate::scan::tokens::{Token, TokenKind};

/// Keywords that start a declaration of a module.
const DECLARING: [&str; 7] = ["fn", "struct", "const", "alias", "override", "var", "const_assert"];

/// A function, constant, type or variable of a module, or a constant inside a function.
#[derive(Debug)]
pub(super) struct Declaration<'t> {
    /// Name; empty for a declaration without a name.
    pub(super) name: &'t str,
    pub(super) name_range: Range<usize>,
    pub(super) is_function: bool,
    /// Maximum nesting in the declaration.
    pub(super) depth: usize,
    /// Number of words and signs in the declaration.
    pub(super) length: u64,
    /// All words in the declaration.
    pub(super) named: Vec<NameUse<'t>>,
    /// Tokens after `=`; `None` for a declaration without a value.
    pub(super) value: Option<Range<usize>>,
}

/// A word in a declaration, which may be the name of another declaration.
#[derive(Debug)]
pub(super) struct NameUse<'t> {
    pub(super) name: &'t str,
    /// Nesting depth of the word.
    pub(super) depth: usize,
}

/// The expression for the number of elements in an array type.
#[derive(Debug)]
pub(super) struct ArraySize {
    pub(super) declaration: usize,
    pub(super) tokens: Range<usize>,
}

/// Outline of a text.
#[derive(Debug, Default)]
pub(super) struct Outline<'t> {
    pub(super) declarations: Vec<Declaration<'t>>,
    pub(super) arrays: Vec<ArraySize>,
}

impl<'t> Outline<'t> {
    /// Reads words and signs. The error is the first place that is nested more than [`DEPTH_LIMIT`] deep.
    pub(super) fn read(text: &'t str, tokens: &[Token]) -> Result<Outline<'t>, Range<usize>> {
        let mut walker = OutlineReader::new(text, tokens);
        while let Some(token) = walker.tokens.get(walker.at).cloned() {
            if !walker.token(&token) {
                break;
            }
            if walker.depth > DEPTH_LIMIT {
                return Err(token.range);
            }
        }
        Ok(walker.outline)
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Bracket {
    File,
    Block,
    Round,
    Square,
    /// A `<` that may start a template list.
    Angle,
}

/// An open bracket.
#[derive(Debug)]
struct OpenBracket {
    bracket: Bracket,
    /// Operators of the current expression.
    operators: usize,
    /// Branches of the current `if` statement after the first. Each counts as nested in the one before it.
    branches: usize,
    /// True for the template list of `array`.
    is_array: bool,
    /// First token of the second template argument.
    second: Option<usize>,
}

struct OutlineReader<'t, 'a> {
    text: &'t str,
    tokens: &'a [Token],
    at: usize,
    open: Vec<OpenBracket>,
    /// Open brackets and operators together.
    depth: usize,
    outline: Outline<'t>,
    /// While a constant inside a function is read: the function, and the number of brackets open around the constant.
    outer: Option<(usize, usize)>,
    expects_name: bool,
}

impl<'t, 'a> OutlineReader<'t, 'a> {
    fn new(text: &'t str, tokens: &'a [Token]) -> OutlineReader<'t, 'a> {
        let mut walker = OutlineReader {
            text,
            tokens,
            at: 0,
            open: Vec::new(),
            depth: 0,
            outline: Outline::default(),
            outer: None,
            expects_name: false,
        };
        walker.push(Bracket::File);
        // The text before the first declaration.
        walker.declare(0..0, false);
        walker
    }

    /// Follows the token at the current place, and the tokens that form one operator with it. Returns false if naga refuses it.
    fn token(&mut self, token: &Token) -> bool {
        let is_read = match token.kind {
            TokenKind::Word => {
                self.word(token.range.clone());
                true
            }
            TokenKind::Sign(sign) => self.sign(sign),
            _ => true,
        };
        self.at += 1;
        let depth = self.depth;
        if let Some(declaration) = self.outline.declarations.last_mut() {
            declaration.length += 1;
            declaration.depth = declaration.depth.max(depth);
        }
        is_read
    }

    fn word(&mut self, range: Range<usize>) {
        let word = self.text.get(range.clone()).unwrap_or("");
        let is_outside = self.open.len() == 1;
        if is_outside && DECLARING.contains(&word) || word == "const" && self.outer.is_none() {
            self.outer = (!is_outside).then_some((self.outline.declarations.len() - 1, self.open.len()));
            self.declare(range, word == "fn");
            self.expects_name = word != "const_assert";
            return;
        }
        let (expects_name, depth) = (self.expects_name, self.depth);
        let is_in_template = self.open.last().is_some_and(|open| open.bracket == Bracket::Angle);
        let Some(declaration) = self.outline.declarations.last_mut() else {
            return;
        };
        // `var<storage, read> name`
        if expects_name && !is_in_template {
            declaration.name = word;
            declaration.name_range = range;
            self.expects_name = false;
        } else if !is_number(word) {
            declaration.named.push(NameUse { name: word, depth });
        }
    }

    fn declare(&mut self, range: Range<usize>, is_function: bool) {
        self.outline.declarations.push(Declaration {
            name: "",
            name_range: range,
            is_function,
            depth: 0,
            length: 0,
            named: Vec::new(),
            value: None,
        });
    }

    /// Follows a sign. Returns false if naga refuses it.
    fn sign(&mut self, sign: char) -> bool {
        match sign {
            '(' => self.push(Bracket::Round),
            '[' => self.push(Bracket::Square),
            '{' => {
                self.end_expression();
                self.push(Bracket::Block);
            }
            ')' => return self.close(Bracket::Round),
            ']' => {
                let is_closed = self.close(Bracket::Square);
                self.operator();
                return is_closed;
            }
            '}' => {
                let is_closed = self.close(Bracket::Block);
                self.end_block();
                return is_closed;
            }
            ';' => {
                self.end_expression();
                self.end_value();
            }
            ',' => self.comma(),
            ':' => self.no_templates(),
            '<' | '>' => self.angle(sign),
            '=' => self.equals(),
            '&' | '|' if self.is_next(sign) => {
                self.at += 1;
                self.no_templates();
                self.operator();
            }
            '-' if self.is_next('>') => self.at += 1,
            '+' | '-' if self.is_next(sign) => {
                self.at += 1;
                self.operator();
            }
            // Assignments such as `+=` end a chain of operators, like `=`.
            '+' | '-' | '*' | '/' | '%' | '&' | '|' | '^' if self.is_next('=') => {}
            '!' if self.is_next('=') => {
                self.at += 1;
                self.operator();
            }
            '+' | '-' | '*' | '/' | '%' | '&' | '|' | '^' | '!' | '~' | '.' => self.operator(),
            _ => {}
        }
        true
    }

    fn angle(&mut self, sign: char) {
        let is_template = self.open.last().is_some_and(|open| open.bracket == Bracket::Angle);
        if sign == '>' && is_template {
            self.end_template();
        } else if self.is_next(sign) || self.is_next('=') {
            // Shifts, comparisons, and `<<=`, whose last sign is then read as an assignment.
            self.at += 1;
            self.operator();
        } else if sign == '<' && self.word_before().is_some() {
            let is_array = matches!(self.word_before(), Some("array" | "binding_array"));
            self.push(Bracket::Angle);
            if let Some(open) = self.open.last_mut() {
                open.is_array = is_array;
            }
        } else {
            self.operator();
        }
    }

    fn equals(&mut self) {
        if self.is_next('=') {
            self.at += 1;
            self.operator();
            return;
        }
        self.no_templates();
        let (at, is_of_value) = (self.at + 1, self.is_in_value());
        if let Some(declaration) = self.outline.declarations.last_mut()
            && is_of_value
            && declaration.value.is_none()
        {
            declaration.value = Some(at..at);
        }
    }

    /// Returns true directly inside the declaration of a constant, outside of any bracket in it.
    fn is_in_value(&self) -> bool {
        self.open.len() == self.outer.map_or(1, |(_, open)| open)
    }

    fn comma(&mut self) {
        let after = self.at + 1;
        if let Some(open) = self.open.last_mut() {
            self.depth -= open.operators;
            open.operators = 0;
            if open.is_array {
                open.second.get_or_insert(after);
            }
        }
    }

    /// Ends the value of a constant, and continues the enclosing function.
    fn end_value(&mut self) {
        if !self.is_in_value() {
            return;
        }
        let end = self.at;
        let Some(declaration) = self.outline.declarations.last_mut() else {
            return;
        };
        if let Some(value) = &mut declaration.value
            && value.end == value.start
        {
            value.end = end;
        }
        if let Some((outer, _)) = self.outer.take() {
            let function = &self.outline.declarations[outer];
            let is_function = function.is_function;
            let (name, name_range) = (function.name, function.name_range.clone());
            // The rest of the function is recorded as another declaration with its name.
            self.declare(name_range, is_function);
            if let Some(rest) = self.outline.declarations.last_mut() {
                rest.name = name;
            }
        }
    }

    fn push(&mut self, bracket: Bracket) {
        self.depth += 1;
        self.open.push(OpenBracket {
            bracket,
            operators: 0,
            branches: 0,
            is_array: false,
            second: None,
        });
    }

    fn pop(&mut self) -> Option<OpenBracket> {
        let open = self.open.pop()?;
        self.depth -= 1 + open.operators + open.branches;
        Some(open)
    }

    fn operator(&mut self) {
        if let Some(open) = self.open.last_mut() {
            open.operators += 1;
            self.depth += 1;
        }
    }

    /// Closes a bracket. Returns false if another bracket is open.
    fn close(&mut self, bracket: Bracket) -> bool {
        self.no_templates();
        if self.open.last().is_none_or(|open| open.bracket != bracket) {
            return false;
        }
        self.pop();
        true
    }

    /// Reinterprets every `<` that is still open as a comparison operator.
    fn no_templates(&mut self) {
        while self.open.last().is_some_and(|open| open.bracket == Bracket::Angle) {
            let operators = self.pop().map_or(0, |open| open.operators);
            for _ in 0..=operators {
                self.operator();
            }
        }
    }

    fn end_template(&mut self) {
        let Some(open) = self.pop() else { return };
        if let Some(first) = open.second {
            self.outline.arrays.push(ArraySize {
                declaration: self.outline.declarations.len() - 1,
                tokens: first..self.at,
            });
        }
    }

    fn end_expression(&mut self) {
        self.no_templates();
        if let Some(open) = self.open.last_mut() {
            self.depth -= open.operators;
            open.operators = 0;
        }
    }

    /// Ends the statement that a block belongs to, unless an `else` follows.
    fn end_block(&mut self) {
        let next = self.tokens.get(self.at + 1);
        let goes_on = next.is_some_and(|next| self.text.get(next.range.clone()) == Some("else"));
        let Some(open) = self.open.last_mut() else { return };
        if goes_on {
            open.branches += 1;
            self.depth += 1;
        } else {
            self.depth -= open.branches;
            open.branches = 0;
        }
    }

    /// Returns true if this sign follows without a blank in between.
    fn is_next(&self, sign: char) -> bool {
        let [Some(token), Some(next)] = [self.tokens.get(self.at), self.tokens.get(self.at + 1)] else {
            return false;
        };
        next.kind == TokenKind::Sign(sign) && next.range.start == token.range.end
    }

    /// Returns the name or keyword before the current place.
    fn word_before(&self) -> Option<&'t str> {
        let before = self.tokens.get(self.at.checked_sub(1)?)?;
        let word = self.text.get(before.range.clone())?;
        (before.kind == TokenKind::Word && !is_number(word)).then_some(word)
    }
}

fn is_number(word: &str) -> bool {
    word.starts_with(|letter: char| letter.is_ascii_digit() || letter == '.')
}
