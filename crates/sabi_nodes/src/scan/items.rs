//! Finds declarations with their names, members, arguments and doc comments.

use std::ops::Range;

use super::tokens::{Token, TokenKind};
use super::{DocLine, Item, ItemKind, Member, doc_line};
use crate::fault::{FAULTS_SHOWN, Fault, Text};

/// Reads declarations, and returns whether the end was reached. Reading stops at text that is not WGSL, which naga reports.
pub(super) fn read_items(text: Text<'_>, tokens: &[Token], faults: &mut Vec<Fault>) -> (Vec<Item>, bool) {
    let mut reader = ItemReader {
        text,
        tokens,
        at: 0,
        is_at_end: false,
        faults,
    };
    let mut items = Vec::new();
    while let Some(item) = reader.item() {
        items.extend(item);
    }
    (items, reader.is_at_end)
}

struct ItemReader<'a> {
    text: Text<'a>,
    tokens: &'a [Token],
    at: usize,
    is_at_end: bool,
    faults: &'a mut Vec<Fault>,
}

impl ItemReader<'_> {
    /// Reads the next declaration; `Some(None)` for a lone semicolon, `None` at the end.
    fn item(&mut self) -> Option<Option<Item>> {
        let docs = self.docs();
        let Some(token) = self.code("a declaration") else {
            self.refuse_docs(&docs, "There is no declaration below this doc comment.");
            self.is_at_end = true;
            return None;
        };
        if token.kind == TokenKind::Sign(';') {
            self.refuse_docs(&docs, "There is no declaration below this doc comment.");
            return Some(None);
        }
        let keyword = self.skip_attributes(token)?;
        let kind = match &self.text.text[keyword.clone()] {
            "fn" => ItemKind::Function,
            "struct" => ItemKind::Struct,
            _ => ItemKind::Other,
        };
        let place = match kind {
            ItemKind::Function => "a function",
            ItemKind::Struct => "a struct",
            ItemKind::Other => "a declaration",
        };
        // `const_assert`, directives and `var<…>` have no name after the keyword.
        let token = self.code(place)?;
        let name_range = if token.kind == TokenKind::Word {
            token.range
        } else {
            self.at -= 1;
            keyword.clone()
        };
        let name = self.text.text[name_range.clone()].to_owned();
        let mut members = Vec::new();
        match kind {
            ItemKind::Struct => {
                self.expect('{')?;
                members = self.members('}')?;
            }
            ItemKind::Function => {
                self.expect('(')?;
                members = self.members(')')?;
                for member in &members {
                    self.refuse_docs(&member.docs, "A doc comment of an argument is lost.");
                }
                self.skip_until(&['{'], "a function")?;
                self.skip_until(&['}'], "a function")?;
            }
            ItemKind::Other => {
                self.skip_until(&[';'], "a declaration")?;
            }
        }
        Some(Some(Item {
            kind,
            keyword,
            name,
            name_range,
            docs,
            members,
        }))
    }

    /// Reads the members or arguments up to the closing bracket.
    fn members(&mut self, close: char) -> Option<Vec<Member>> {
        let mut members = Vec::new();
        loop {
            let docs = self.docs();
            let token = self.code("a list")?;
            if token.kind == TokenKind::Sign(close) {
                self.refuse_docs(&docs, "There is nothing below this doc comment.");
                return Some(members);
            }
            let name_range = self.skip_attributes(token)?;
            self.expect(':')?;
            let (end, type_range) = self.type_until(&[',', close])?;
            members.push(Member {
                name: self.text.text[name_range.clone()].to_owned(),
                name_range,
                type_range,
                docs,
            });
            if end == close {
                return Some(members);
            }
        }
    }

    /// Reads the doc comments at the current place. A plain comment ends them, as in naga.
    fn docs(&mut self) -> Vec<DocLine> {
        let mut docs = Vec::new();
        while let Some(token) = self.tokens.get(self.at) {
            if token.kind != TokenKind::Doc {
                break;
            }
            docs.push(doc_line(self.text, token));
            self.at += 1;
        }
        docs
    }

    /// Returns the next token that is code. A doc comment before it documents nothing, which is a fault.
    fn code(&mut self, place: &str) -> Option<Token> {
        let mut is_reported = false;
        loop {
            let token = self.tokens.get(self.at)?.clone();
            self.at += 1;
            match token.kind {
                TokenKind::Word | TokenKind::Sign(_) => return Some(token),
                // Doc comments after code or below a plain comment are reported by `misplaced_comments`.
                TokenKind::Doc if !token.after_code && !is_reported && !self.is_below_plain() => {
                    is_reported = true;
                    let message = format!("A doc comment inside {place} describes nothing.");
                    self.refuse(token.range, &message, "Make it a plain `//` comment.");
                }
                _ => {}
            }
        }
    }

    /// Returns true if the token read last is a doc line below a plain comment.
    fn is_below_plain(&self) -> bool {
        self.tokens[..self.at.saturating_sub(1)]
            .iter()
            .rev()
            .find(|token| token.kind != TokenKind::Doc)
            .is_some_and(|token| token.kind == TokenKind::Plain)
    }

    fn refuse_docs(&mut self, docs: &[DocLine], message: &str) {
        if let Some(first) = docs.first() {
            let advice = if message.contains("argument") {
                "Describe inputs with `@input name …` in the doc comment of the function."
            } else {
                "Remove it, or make it a plain `//` comment."
            };
            self.refuse(first.start..first.start + first.text.len(), message, advice);
        }
    }

    fn refuse(&mut self, range: Range<usize>, message: &str, advice: &str) {
        if self.faults.len() < FAULTS_SHOWN {
            self.faults.push(self.text.fault(range, message, advice));
        }
    }

    fn expect(&mut self, sign: char) -> Option<()> {
        (self.code("a declaration")?.kind == TokenKind::Sign(sign)).then_some(())
    }

    /// Skips `@word(…)`, and returns the next word.
    fn skip_attributes(&mut self, mut token: Token) -> Option<Range<usize>> {
        while token.kind == TokenKind::Sign('@') {
            self.code("an attribute")?;
            token = self.code("an attribute")?;
            if token.kind == TokenKind::Sign('(') {
                self.skip_until(&[')'], "an attribute")?;
                token = self.code("an attribute")?;
            }
        }
        (token.kind == TokenKind::Word).then_some(token.range)
    }

    /// Skips balanced code up to and including one of the signs.
    fn skip_until(&mut self, signs: &[char], place: &str) -> Option<char> {
        let mut depth = 0;
        loop {
            if let TokenKind::Sign(sign) = self.code(place)?.kind {
                if depth == 0 && signs.contains(&sign) {
                    return Some(sign);
                }
                match sign {
                    '(' | '[' | '{' => depth += 1,
                    ')' | ']' | '}' => depth -= 1,
                    _ => {}
                }
                if depth < 0 {
                    return None;
                }
            }
        }
    }

    /// Reads a type up to one of the signs, and returns the sign and the range of the type.
    fn type_until(&mut self, signs: &[char]) -> Option<(char, Range<usize>)> {
        let mut depth = 0;
        let mut range: Option<Range<usize>> = None;
        loop {
            let token = self.code("a list")?;
            if let TokenKind::Sign(sign) = token.kind {
                if depth == 0 && signs.contains(&sign) {
                    return Some((sign, range?));
                }
                match sign {
                    '(' | '[' | '<' => depth += 1,
                    ')' | ']' | '>' => depth -= 1,
                    _ => {}
                }
                if depth < 0 {
                    return None;
                }
            }
            range = Some(range.map_or(token.range.clone(), |range| range.start..token.range.end));
        }
    }
}
