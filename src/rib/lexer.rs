//! From bytes to requests with their arguments: the syntax of RIB in ASCII (RenderMan Interface 3.2, appendix C.1).
//!
//! A request is a word, and its arguments are all numbers, strings and arrays up to the next word. So a request that
//! nobody knows can be left out without knowing what its arguments are.

use std::path::Path;
use std::sync::Arc;

use super::place::{Place, quoted};
use super::request::{Argument, Request, Value};
use super::strings;
use crate::error::{Error, Result};

const GZIP: &[u8] = &[0x1f, 0x8b];
const BYTE_ORDER_MARK: &[u8] = &[0xef, 0xbb, 0xbf];
const NOT_RIB: &str = "is this a RIB file, and is it whole?";

/// Reads requests, one after the other. A copy goes on from the same place.
#[derive(Clone, Debug)]
pub(super) struct Lexer {
    bytes: Arc<[u8]>,
    at: usize,
    end: usize,
    place: Place,
}

impl Lexer {
    /// # Errors
    /// [`Error::Format`] if the file is compressed.
    pub(super) fn new(path: Arc<Path>, bytes: &[u8]) -> Result<Self> {
        let place = Place { path, line: 1 };
        if bytes.starts_with(GZIP) {
            return Err(
                place.wrong("the file is compressed with gzip", "unpack it first: gunzip < FILE > NEW.rib")
            );
        }
        let at = if bytes.starts_with(BYTE_ORDER_MARK) { BYTE_ORDER_MARK.len() } else { 0 };
        Ok(Self { bytes: bytes.into(), at, end: bytes.len(), place })
    }

    /// Where it is.
    pub(super) fn place(&self) -> Place {
        self.place.clone()
    }

    /// Number of bytes that are left.
    pub(super) fn length(&self) -> usize {
        self.end - self.at
    }

    /// The part from here up to where another one of the same file is.
    pub(super) fn until(&self, other: &Self) -> Self {
        Self { end: other.at, ..self.clone() }
    }

    /// The next request, if there is one.
    pub(super) fn request(&mut self) -> Result<Option<Request>> {
        let Some(byte) = self.peek()? else { return Ok(None) };
        if !byte.is_ascii_alphabetic() {
            let problem = "something other than the name of a request stands where one should be";
            return Err(self.wrong(problem, NOT_RIB));
        }
        let place = self.place();
        let name = self.word(|byte| byte.is_ascii_alphanumeric() || byte == b'_');
        let mut arguments = Vec::new();
        while let Some(argument) = self.argument()? {
            arguments.push(argument);
        }
        Ok(Some(Request::new(name, place, arguments)))
    }

    /// The next argument, unless a request or the end comes first.
    fn argument(&mut self) -> Result<Option<Argument>> {
        let Some(byte) = self.peek()? else { return Ok(None) };
        let place = self.place();
        let value = match byte {
            b'[' => self.array()?,
            b'"' => Value::Text(self.text()?),
            byte if byte.is_ascii_alphabetic() => return Ok(None),
            _ => Value::Number(self.number()?),
        };
        Ok(Some(Argument { value, place }))
    }

    /// An array of numbers or of strings; an empty one is of numbers.
    fn array(&mut self) -> Result<Value> {
        let opened = self.place();
        self.at += 1;
        let (mut numbers, mut texts) = (Vec::new(), Vec::new());
        loop {
            match self.peek()? {
                Some(b']') => break,
                Some(b'"') => texts.push(self.text()?),
                Some(byte) if !byte.is_ascii_alphabetic() && byte != b'[' => numbers.push(self.number()?),
                _ => return Err(opened.wrong("the array that begins here has no end", "close it with `]`")),
            }
        }
        self.at += 1;
        match (numbers.is_empty(), texts.is_empty()) {
            (_, true) => Ok(Value::Numbers(numbers)),
            (true, false) => Ok(Value::Texts(texts)),
            (false, false) => {
                Err(opened
                    .wrong("the array that begins here has both numbers and strings", "split it in two"))
            }
        }
    }

    fn number(&mut self) -> Result<f64> {
        let word = self.word(|byte| byte.is_ascii_digit() || b"+-.eE".contains(&byte));
        match word.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            Ok(_) => Err(self.wrong(format!("{} is too large", quoted(&word)), "use smaller numbers")),
            Err(_) => {
                let word = if word.is_empty() { self.word(|byte| byte.is_ascii_graphic()) } else { word };
                let problem = format!("{} is neither a number nor a string nor an array", quoted(&word));
                Err(self.wrong(problem, NOT_RIB))
            }
        }
    }

    fn text(&mut self) -> Result<String> {
        let opened = self.place();
        let rest = &self.bytes[self.at + 1..self.end];
        let Some((text, length)) = strings::unescaped(rest) else {
            return Err(opened.wrong("the string that begins here has no end", "close it with `\"`"));
        };
        self.place.line += lines(&rest[..length]);
        self.at += 1 + length;
        Ok(text)
    }

    /// The bytes from here on that belong to a word.
    fn word(&mut self, belongs: impl Fn(u8) -> bool) -> String {
        let rest = &self.bytes[self.at..self.end];
        let length = rest.iter().position(|&byte| !belongs(byte)).unwrap_or(rest.len());
        self.at += length;
        String::from_utf8_lossy(&rest[..length]).into_owned()
    }

    /// The first byte of what comes next.
    fn peek(&mut self) -> Result<Option<u8>> {
        while let Some(&byte) = self.bytes[..self.end].get(self.at) {
            match byte {
                b'\n' => self.place.line += 1,
                b' ' | b'\t' | b'\r' | 0x0b | 0x0c => {}
                b'#' => self.skip_comment(),
                0x80.. => return Err(self.binary()),
                _ => return Ok(Some(byte)),
            }
            self.at += 1;
        }
        Ok(None)
    }

    /// To the last byte of a comment. Old files may end lines with a carriage return alone.
    fn skip_comment(&mut self) {
        let is_last = |next: &&u8| matches!(next, b'\n' | b'\r');
        while self.bytes[..self.end].get(self.at + 1).is_some_and(|next| !is_last(&next)) {
            self.at += 1;
        }
    }

    fn binary(&self) -> Error {
        self.wrong("this is binary RIB, or no RIB at all", "convert it to ASCII: catrib -o NEW.rib FILE")
    }

    fn wrong(&self, problem: impl Into<String>, remedy: impl Into<String>) -> Error {
        self.place.wrong(problem, remedy)
    }
}

fn lines(bytes: &[u8]) -> usize {
    bytes.iter().filter(|&&byte| byte == b'\n').count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn requests(text: &[u8]) -> Result<Vec<(String, usize, Vec<Value>)>> {
        let mut lexer = Lexer::new(Path::new("x.rib").into(), text)?;
        let mut found = Vec::new();
        while let Some(request) = lexer.request()? {
            let (name, line) = (request.name.clone(), request.place.line);
            found.push((name, line, request.into_values()));
        }
        Ok(found)
    }

    #[test]
    fn requests_end_where_the_next_one_begins() {
        let text = b"##RenderMan RIB\nversion 3.03 # comment \"[\nFoo\"a\"[1 2]-3[\"b\" \"c\"] [] \n\nBar";
        let expected = [
            ("version".to_owned(), 2, vec![Value::Number(3.03)]),
            (
                "Foo".to_owned(),
                3,
                vec![
                    Value::Text("a".to_owned()),
                    Value::Numbers(vec![1.0, 2.0]),
                    Value::Number(-3.0),
                    Value::Texts(vec!["b".to_owned(), "c".to_owned()]),
                    Value::Numbers(vec![]),
                ],
            ),
            ("Bar".to_owned(), 5, vec![]),
        ];
        assert_eq!(requests(text).expect("readable"), expected);
    }

    #[test]
    fn numbers_of_every_form_are_read() {
        let [(_, _, values)] =
            &requests(b"A [1 +1 -1 .5 -.5 2. 1e3 1E-3 +2.5e+2 3.e1 007]").expect("readable")[..]
        else {
            panic!("one request");
        };
        let expected = [1.0, 1.0, -1.0, 0.5, -0.5, 2.0, 1000.0, 0.001, 250.0, 30.0, 7.0];
        assert_eq!(*values, [Value::Numbers(expected.to_vec())]);
    }

    #[test]
    fn errors_name_the_line() {
        for (text, line, part) in [
            (&b"\n7"[..], 2, "name of a request"),
            (b"A\n[1 2", 2, "no end"),
            (b"A\n\"x\n", 2, "no end"),
            (b"A \"x\ny\"\n[1 \"x\"]", 3, "both"),
            (b"A [1\n[2]]", 1, "no end"),
            (b"A [1 B]", 1, "no end"),
            (b"A\n1e", 2, "`1e`"),
            (b"A 1.2.3", 1, "`1.2.3`"),
            (b"A ]", 1, "`]`"),
            (b"A\n\n1e999", 3, "too large"),
            (b"\x1f\x8b\x08\0", 1, "gzip"),
            (b"A\n\xa6\x01", 2, "binary"),
            (b"A \0", 1, "neither"),
        ] {
            match requests(text) {
                Err(Error::Format { line: found, problem, .. }) => {
                    assert_eq!(found, line, "{text:?}");
                    assert!(problem.contains(part), "{problem}");
                }
                other => panic!("{text:?} gave {other:?}"),
            }
        }
    }

    #[test]
    fn lines_end_in_any_way_and_other_letters_stand_in_comments_and_strings() {
        let text = "\u{feff}A 1 # für\r\nB \"größe\"\rC";
        let found = requests(text.as_bytes()).expect("readable");
        assert_eq!(found.len(), 3);
        assert_eq!(found[1].2, [Value::Text("größe".to_owned())]);
    }
}
