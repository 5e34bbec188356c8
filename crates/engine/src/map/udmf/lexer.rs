//! UDMF text cut into tokens.

use super::error::{UdmfError, UdmfFault};

/// A token and the byte offset where it begins.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Token<'a> {
    pub offset: usize,
    pub kind: TokenKind<'a>,
}

#[derive(Clone, PartialEq, Debug)]
pub(super) enum TokenKind<'a> {
    /// A name or keyword, as written.
    Word(&'a str),
    Integer(i64),
    Float(f64),
    Text(String),
    /// `{`, `}`, `=` or `;`.
    Mark(u8),
    End,
}

impl TokenKind<'_> {
    /// The token as an error message names it.
    pub fn describe(&self) -> String {
        match self {
            TokenKind::Word(word) => format!("`{}`", shortened(word)),
            TokenKind::Integer(value) => format!("the number {value}"),
            TokenKind::Float(value) => format!("the number {value}"),
            TokenKind::Text(_) => "a string".to_owned(),
            TokenKind::Mark(mark) => format!("`{}`", char::from(*mark)),
            TokenKind::End => "the end of the text".to_owned(),
        }
    }
}

fn shortened(text: &str) -> String {
    if text.chars().count() <= 40 {
        text.to_owned()
    } else {
        text.chars().take(40).collect::<String>() + "..."
    }
}

pub(super) struct Lexer<'a> {
    text: &'a [u8],
    at: usize,
}

impl<'a> Lexer<'a> {
    pub fn new(text: &'a [u8]) -> Lexer<'a> {
        // A byte order mark is no part of the text.
        Lexer { text, at: if text.starts_with(b"\xEF\xBB\xBF") { 3 } else { 0 } }
    }

    pub fn fault(&self, offset: usize, fault: UdmfFault) -> UdmfError {
        UdmfError::at(self.text, offset, fault)
    }

    pub fn next(&mut self) -> Result<Token<'a>, UdmfError> {
        self.skip_blank()?;
        let offset = self.at;
        let Some(&first) = self.text.get(offset) else {
            return Ok(Token { offset, kind: TokenKind::End });
        };
        let kind = match first {
            b'{' | b'}' | b'=' | b';' => {
                self.at += 1;
                TokenKind::Mark(first)
            }
            b'"' => self.string()?,
            b'+' | b'-' | b'0'..=b'9' | b'.' => self.number()?,
            b'a'..=b'z' | b'A'..=b'Z' | b'_' => TokenKind::Word(self.run()),
            _ => {
                let found = format!(
                    "`{}`",
                    String::from_utf8_lossy(&self.text[offset..=offset]).escape_debug()
                );
                return Err(self.fault(
                    offset,
                    UdmfFault::Expected { what: "a name, a value or a mark", found },
                ));
            }
        };
        Ok(Token { offset, kind })
    }

    fn skip_blank(&mut self) -> Result<(), UdmfError> {
        loop {
            let rest = &self.text[self.at..];
            match rest {
                [b' ' | b'\t' | b'\r' | b'\n' | 0x0B | 0x0C, ..] => self.at += 1,
                [b'/', b'/', ..] => {
                    self.at += rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
                }
                [b'/', b'*', ..] => match rest[2..].windows(2).position(|pair| pair == b"*/") {
                    Some(length) => self.at += length + 4,
                    None => {
                        return Err(
                            self.fault(self.at, UdmfFault::Unterminated { what: "comment" })
                        );
                    }
                },
                // Some editors end the lump with a zero byte.
                [0, rest @ ..] if rest.iter().all(|&byte| byte == 0) => self.at = self.text.len(),
                _ => return Ok(()),
            }
        }
    }

    /// The longest run of characters that names and numbers are made of.
    fn run(&mut self) -> &'a str {
        let start = self.at;
        let word =
            |byte: &u8| byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'.' | b'+' | b'-');
        self.at += self.text[start..].iter().take_while(|byte| word(byte)).count();
        // All bytes taken are ASCII.
        std::str::from_utf8(&self.text[start..self.at]).unwrap_or_default()
    }

    fn string(&mut self) -> Result<TokenKind<'a>, UdmfError> {
        let start = self.at;
        let mut bytes = Vec::new();
        self.at += 1;
        loop {
            match self.text.get(self.at..).unwrap_or_default() {
                [b'"', ..] => {
                    self.at += 1;
                    return Ok(TokenKind::Text(String::from_utf8_lossy(&bytes).into_owned()));
                }
                [b'\\', escaped, ..] => {
                    bytes.push(*escaped);
                    self.at += 2;
                }
                [byte, ..] => {
                    bytes.push(*byte);
                    self.at += 1;
                }
                [] => return Err(self.fault(start, UdmfFault::Unterminated { what: "string" })),
            }
        }
    }

    fn number(&mut self) -> Result<TokenKind<'a>, UdmfError> {
        let start = self.at;
        let run = self.run();
        parse_number(run)
            .ok_or_else(|| self.fault(start, UdmfFault::Number { text: shortened(run) }))
    }
}

/// Integers in decimal, hexadecimal (`0x`) and octal (leading `0`); floats with a point or an
/// exponent.
fn parse_number<'a>(run: &str) -> Option<TokenKind<'a>> {
    let (negative, digits) = match run.as_bytes() {
        [b'-', ..] => (true, &run[1..]),
        [b'+', ..] => (false, &run[1..]),
        _ => (false, run),
    };
    let sign = if negative { -1 } else { 1 };
    let integer = |digits: &str, radix| {
        let all_digits =
            !digits.is_empty() && digits.bytes().all(|byte| char::from(byte).is_digit(radix));
        all_digits
            .then(|| i64::from_str_radix(digits, radix).ok())
            .flatten()
            .map(|v| TokenKind::Integer(sign * v))
    };
    if let Some(hexadecimal) = digits.strip_prefix("0x").or_else(|| digits.strip_prefix("0X")) {
        return integer(hexadecimal, 16);
    }
    if digits.bytes().all(|byte| byte.is_ascii_digit()) {
        let octal = digits.len() > 1 && digits.starts_with('0');
        return integer(digits, if octal { 8 } else { 10 });
    }
    // `f64` would also read `inf`, `nan` and a second sign.
    if !digits.starts_with(|first: char| first.is_ascii_digit() || first == '.') {
        return None;
    }
    let value: f64 = digits.parse().ok()?;
    value.is_finite().then(|| TokenKind::Float(if negative { -value } else { value }))
}
