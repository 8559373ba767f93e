//! Expressions and conditions as they are written: from characters to a tree whose parts know their place.

use std::ops::Range;

/// Brackets and signs that may stand one within the other.
const DEEPEST: usize = 200;

/// Numbers, names and signs of an expression.
const MOST_TOKENS: usize = 1000;

/// An expression with its place in the text, in bytes.
#[derive(Debug, Clone, PartialEq)]
pub struct Expression {
    /// What it is.
    pub kind: Kind,
    /// Where it stands.
    pub at: Range<usize>,
}

/// What an expression is.
#[derive(Debug, Clone, PartialEq)]
pub enum Kind {
    /// A number.
    Number(f64),
    /// A name.
    Name(String),
    /// A function of arguments.
    Call(String, Vec<Expression>),
    /// The negative.
    Minus(Box<Expression>),
    /// Two expressions joined by an operator.
    Joined(Operator, Box<[Expression; 2]>),
}

/// What joins two expressions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Operator {
    /// `+`
    Plus,
    /// `-`
    Minus,
    /// `*`
    Times,
    /// `/`
    Over,
    /// `^` or `**`
    Power,
}

/// A condition that one expression is greater than another.
#[derive(Debug, Clone, PartialEq)]
pub struct Condition {
    /// The greater one, and the lesser one.
    pub sides: [Expression; 2],
}

/// What keeps characters from being an expression, and where.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Misread {
    /// Byte of the text.
    pub at: usize,
    /// What is wrong.
    pub message: String,
}

/// Reads an expression that begins at a byte of the text.
///
/// # Errors
/// Where the characters are none.
pub fn expression(characters: &str, begins: usize) -> Result<Expression, Misread> {
    let mut reader = Reading::of(characters, begins)?;
    let found = reader.sum(0)?;
    reader.ends("an operator")?;
    Ok(found)
}

/// Reads a condition: `a < b`, `a > b`, or the same with `=`.
///
/// # Errors
/// Where the characters are none.
pub fn condition(characters: &str, begins: usize) -> Result<Condition, Misread> {
    let mut reader = Reading::of(characters, begins)?;
    let left = reader.sum(0)?;
    let relation = reader.next().map(|it| (it.token.clone(), it.at));
    let Some((Token::Relation(is_greater), _)) = relation else {
        let at = relation.map_or(begins + characters.len(), |(_, at)| at);
        return Err(Misread { at, message: "expected < or > between two expressions".into() });
    };
    let right = reader.sum(0)?;
    reader.ends("the end of the condition")?;
    Ok(Condition { sides: if is_greater { [left, right] } else { [right, left] } })
}

/// The smallest part of an expression.
#[derive(Debug, Clone, PartialEq)]
enum Token {
    Number(f64),
    Name(String),
    Operator(Operator),
    /// Whether what stands before it is the greater side.
    Relation(bool),
    Opens,
    Closes,
    Comma,
}

#[derive(Debug, Clone)]
struct Placed {
    token: Token,
    at: usize,
    ends: usize,
}

/// Characters that are read token by token.
struct Reading {
    tokens: Vec<Placed>,
    next: usize,
    ends: usize,
}

impl Reading {
    fn of(characters: &str, begins: usize) -> Result<Self, Misread> {
        let mut tokens = Vec::new();
        let mut rest = characters.char_indices().peekable();
        while let Some((at, first)) = rest.next() {
            let two = characters[at..].chars().take(2).collect::<String>();
            let token = match first {
                it if it.is_whitespace() => continue,
                '0'..='9' | '.' => {
                    let length = length_of_number(&characters[at..]);
                    let digits = &characters[at..at + length];
                    let Ok(number) = digits.parse() else {
                        let message = format!("{digits} is no number");
                        return Err(Misread { at: begins + at, message });
                    };
                    while rest.next_if(|(next, _)| *next < at + length).is_some() {}
                    let (token, ends) = (Token::Number(number), begins + at + length);
                    tokens.push(Placed { token, at: begins + at, ends });
                    continue;
                }
                it if it.is_alphabetic() || it == '_' => {
                    let name: String = characters[at..].chars().take_while(is_of_name).collect();
                    while rest.next_if(|(next, _)| *next < at + name.len()).is_some() {}
                    let ends = begins + at + name.len();
                    tokens.push(Placed { token: Token::Name(name), at: begins + at, ends });
                    continue;
                }
                _ if two == "**" => Token::Operator(Operator::Power),
                _ if two == "<=" => Token::Relation(false),
                _ if two == ">=" => Token::Relation(true),
                '+' => Token::Operator(Operator::Plus),
                '-' => Token::Operator(Operator::Minus),
                '*' => Token::Operator(Operator::Times),
                '/' => Token::Operator(Operator::Over),
                '^' => Token::Operator(Operator::Power),
                '<' => Token::Relation(false),
                '>' => Token::Relation(true),
                '(' => Token::Opens,
                ')' => Token::Closes,
                ',' => Token::Comma,
                other => {
                    let message = format!("{other:?} has no meaning in an expression");
                    return Err(Misread { at: begins + at, message });
                }
            };
            let length = if ["**", "<=", ">="].contains(&two.as_str()) { 2 } else { 1 };
            if length == 2 {
                rest.next();
            }
            tokens.push(Placed { token, at: begins + at, ends: begins + at + length });
        }
        if let Some(it) = tokens.get(MOST_TOKENS) {
            let message = format!(
                "more than {MOST_TOKENS} numbers, names and signs: write parts of it as definitions"
            );
            return Err(Misread { at: it.at, message });
        }
        Ok(Reading { tokens, next: 0, ends: begins + characters.len() })
    }

    fn peek(&self) -> Option<&Token> {
        self.tokens.get(self.next).map(|it| &it.token)
    }

    fn next(&mut self) -> Option<&Placed> {
        self.next += 1;
        self.tokens.get(self.next - 1)
    }

    /// Where the next token begins, or the characters end.
    fn place(&self) -> usize {
        self.tokens.get(self.next).map_or(self.ends, |it| it.at)
    }

    /// Where the last token that was read ends.
    fn end(&self) -> usize {
        self.tokens[self.next - 1].ends
    }

    fn takes(&mut self, token: &Token) -> bool {
        let is_next = self.peek() == Some(token);
        self.next += usize::from(is_next);
        is_next
    }

    fn ends(&self, expected: &str) -> Result<(), Misread> {
        match self.peek() {
            None => Ok(()),
            Some(_) => Err(self.expected(expected)),
        }
    }

    fn expected(&self, what: &str) -> Misread {
        Misread { at: self.place(), message: format!("expected {what}") }
    }

    fn sum(&mut self, depth: usize) -> Result<Expression, Misread> {
        let mut left = self.product(depth)?;
        loop {
            let operator = match self.peek() {
                Some(Token::Operator(it @ (Operator::Plus | Operator::Minus))) => *it,
                _ => return Ok(left),
            };
            self.next += 1;
            left = joined(operator, left, self.product(depth)?);
        }
    }

    fn product(&mut self, depth: usize) -> Result<Expression, Misread> {
        let mut left = self.signed(depth)?;
        loop {
            let operator = match self.peek() {
                Some(Token::Operator(it @ (Operator::Times | Operator::Over))) => *it,
                _ => return Ok(left),
            };
            self.next += 1;
            left = joined(operator, left, self.signed(depth)?);
        }
    }

    fn signed(&mut self, depth: usize) -> Result<Expression, Misread> {
        if depth > DEEPEST {
            let message = format!("more than {DEEPEST} brackets and signs within each other");
            return Err(Misread { at: self.place(), message });
        }
        let begins = self.place();
        if self.takes(&Token::Operator(Operator::Plus)) {
            return self.signed(depth + 1);
        }
        if !self.takes(&Token::Operator(Operator::Minus)) {
            return self.power(depth);
        }
        let of = self.signed(depth + 1)?;
        let at = begins..of.at.end;
        Ok(Expression { kind: Kind::Minus(Box::new(of)), at })
    }

    fn power(&mut self, depth: usize) -> Result<Expression, Misread> {
        let base = self.atom(depth)?;
        if !self.takes(&Token::Operator(Operator::Power)) {
            return Ok(base);
        }
        let exponent = self.signed(depth + 1)?;
        Ok(joined(Operator::Power, base, exponent))
    }

    fn atom(&mut self, depth: usize) -> Result<Expression, Misread> {
        let begins = self.place();
        let token = self.next().map(|it| it.token.clone());
        let kind = match token {
            Some(Token::Number(number)) => Kind::Number(number),
            Some(Token::Name(name)) if self.takes(&Token::Opens) => {
                Kind::Call(name, self.arguments(depth)?)
            }
            Some(Token::Name(name)) => Kind::Name(name),
            Some(Token::Opens) => {
                let within = self.sum(depth + 1)?;
                if !self.takes(&Token::Closes) {
                    return Err(self.expected("an operator or )"));
                }
                within.kind
            }
            _ => {
                self.next -= 1;
                return Err(self.expected("a number, a name or ("));
            }
        };
        Ok(Expression { kind, at: begins..self.end() })
    }

    fn arguments(&mut self, depth: usize) -> Result<Vec<Expression>, Misread> {
        let mut arguments = vec![self.sum(depth + 1)?];
        while self.takes(&Token::Comma) {
            arguments.push(self.sum(depth + 1)?);
        }
        match self.takes(&Token::Closes) {
            true => Ok(arguments),
            false => Err(self.expected("an operator, a comma or )")),
        }
    }
}

fn joined(operator: Operator, left: Expression, right: Expression) -> Expression {
    let at = left.at.start..right.at.end;
    Expression { kind: Kind::Joined(operator, Box::new([left, right])), at }
}

/// Whether a character may stand in a name.
fn is_of_name(it: &char) -> bool {
    it.is_alphanumeric() || *it == '_'
}

/// Whether a name can be used in expressions.
pub fn is_name(name: &str) -> bool {
    let first = name.chars().next();
    first.is_some_and(|it| it.is_alphabetic() || it == '_')
        && name.chars().all(|it| is_of_name(&it))
}

/// How many bytes at the start belong to a number.
fn length_of_number(characters: &str) -> usize {
    let bytes = characters.as_bytes();
    let digits = |from: usize| bytes[from..].iter().take_while(|it| it.is_ascii_digit()).count();
    let mut length = digits(0);
    if bytes.get(length) == Some(&b'.') {
        length += 1 + digits(length + 1);
    }
    if matches!(bytes.get(length), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(length + 1), Some(b'+' | b'-')));
        let exponent = digits((length + 1 + sign).min(bytes.len()));
        if exponent > 0 {
            length += 1 + sign + exponent;
        }
    }
    length
}
