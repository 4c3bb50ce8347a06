//! A request and its arguments, taken one after the other.

use std::iter::Peekable;
use std::vec::IntoIter;

use super::place::{Place, quoted};
use crate::error::{Error, Result};

/// Largest magnitude of a coordinate, as in scene files.
pub(super) const MAX_NUMBER: f64 = 1.0e12;

/// What an argument can be.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Value {
    Number(f64),
    Text(String),
    Numbers(Vec<f64>),
    Texts(Vec<String>),
}

impl Value {
    /// As a list of numbers, which a single one is too.
    pub(super) fn numbers(self) -> Option<Vec<f64>> {
        match self {
            Self::Number(number) => Some(vec![number]),
            Self::Numbers(numbers) => Some(numbers),
            Self::Text(_) | Self::Texts(_) => None,
        }
    }

    /// As a string, which an array of one string is too.
    pub(super) fn text(self) -> Option<String> {
        match self {
            Self::Text(text) => Some(text),
            Self::Texts(texts) => <[String; 1]>::try_from(texts).ok().map(|[text]| text),
            Self::Number(_) | Self::Numbers(_) => None,
        }
    }
}

/// An argument and where it stands.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Argument {
    pub(super) value: Value,
    pub(super) place: Place,
}

/// A request. Its arguments are there until they are taken.
#[derive(Debug)]
pub(super) struct Request {
    pub(super) name: String,
    pub(super) place: Place,
    arguments: Peekable<IntoIter<Argument>>,
}

impl Request {
    pub(super) fn new(name: String, place: Place, arguments: Vec<Argument>) -> Self {
        Self { name, place, arguments: arguments.into_iter().peekable() }
    }

    /// An error with this request.
    pub(super) fn wrong(&self, problem: impl std::fmt::Display, remedy: impl Into<String>) -> Error {
        self.place.wrong(format!("{}: {problem}", quoted(&self.name)), remedy)
    }

    fn missing(&mut self, what: &str) -> Error {
        let name = quoted(&self.name);
        match self.arguments.peek() {
            Some(other) => {
                let problem = format!("{name}: its {what} should stand here");
                other.place.wrong(problem, format!("see the arguments of {name} in the RenderMan Interface"))
            }
            None => self.wrong(format_args!("its {what} is missing"), "is the file cut short?"),
        }
    }

    /// The next argument, of any kind.
    pub(super) fn take(&mut self) -> Option<Argument> {
        self.arguments.next()
    }

    #[cfg(test)]
    pub(super) fn into_values(self) -> Vec<Value> {
        self.arguments.map(|argument| argument.value).collect()
    }

    /// Is the next argument an array?
    pub(super) fn has_array(&mut self) -> bool {
        let next = self.arguments.peek().map(|argument| &argument.value);
        matches!(next, Some(Value::Numbers(_) | Value::Texts(_)))
    }

    /// Is the next argument a number, or numbers?
    pub(super) fn has_number(&mut self) -> bool {
        let next = self.arguments.peek().map(|argument| &argument.value);
        matches!(next, Some(Value::Number(_) | Value::Numbers(_)))
    }

    /// Is there another argument?
    pub(super) fn has_more(&mut self) -> bool {
        self.arguments.peek().is_some()
    }

    fn take_if(&mut self, what: &str, fits: impl Fn(&Value) -> bool) -> Result<Value> {
        match self.arguments.next_if(|argument| fits(&argument.value)) {
            Some(argument) => Ok(argument.value),
            None => Err(self.missing(what)),
        }
    }

    /// The next argument, a number.
    pub(super) fn number(&mut self, what: &str) -> Result<f64> {
        let is_one = |value: &Value| match value {
            Value::Number(_) => true,
            Value::Numbers(numbers) => numbers.len() == 1,
            _ => false,
        };
        let numbers = self.take_if(what, is_one)?.numbers().unwrap_or_default();
        Ok(numbers.first().copied().unwrap_or_default())
    }

    /// The next argument, a whole number that is not negative.
    pub(super) fn count(&mut self, what: &str) -> Result<usize> {
        let number = self.number(what)?;
        whole(number).map(|whole| whole as usize).ok_or_else(|| {
            self.wrong(format_args!("its {what} is {number}"), "use a whole number that is not negative")
        })
    }

    /// The next argument, a string.
    pub(super) fn text(&mut self, what: &str) -> Result<String> {
        Ok(self.take_if(what, |value| matches!(value, Value::Text(_)))?.text().unwrap_or_default())
    }

    /// The next argument, a handle: a number or a string.
    pub(super) fn handle(&mut self) -> Result<String> {
        match self.take_if("handle", |value| matches!(value, Value::Text(_) | Value::Number(_)))? {
            Value::Number(number) => Ok(number.to_string()),
            value => Ok(value.text().unwrap_or_default()),
        }
    }

    /// The next argument, an array of numbers.
    pub(super) fn numbers(&mut self, what: &str) -> Result<Vec<f64>> {
        let value = self.take_if(what, |value| matches!(value, Value::Number(_) | Value::Numbers(_)))?;
        Ok(value.numbers().unwrap_or_default())
    }

    /// The next argument, an array of strings.
    pub(super) fn texts(&mut self, what: &str) -> Result<Vec<String>> {
        let is_list = |value: &Value| match value {
            Value::Texts(_) => true,
            Value::Numbers(numbers) => numbers.is_empty(),
            _ => false,
        };
        match self.take_if(what, is_list)? {
            Value::Texts(texts) => Ok(texts),
            _ => Ok(Vec::new()),
        }
    }

    /// The next argument, an array of whole numbers that are not negative.
    pub(super) fn indices(&mut self, what: &str) -> Result<Vec<u32>> {
        let numbers = self.numbers(what)?;
        let indices: Option<Vec<u32>> = numbers.iter().copied().map(whole).collect();
        indices.ok_or_else(|| {
            let odd = numbers.iter().copied().find(|&number| whole(number).is_none()).unwrap_or_default();
            self.wrong(format_args!("{odd} is among its {what}"), "use whole numbers that are not negative")
        })
    }

    /// The next `N` numbers, be they an array or arguments of their own.
    pub(super) fn list<const N: usize>(&mut self, what: &str) -> Result<[f64; N]> {
        let mut list = Vec::with_capacity(N);
        while list.len() < N && (list.is_empty() || self.has_number()) {
            list.extend(self.numbers(what)?);
        }
        let count = list.len();
        let list: [f64; N] = list.try_into().map_err(|_| {
            self.wrong(format_args!("its {what} has {count} numbers"), format!("give it {N}"))
        })?;
        if list.iter().all(|number| number.abs() <= MAX_NUMBER) {
            return Ok(list);
        }
        Err(self.wrong(format_args!("a number of its {what} is beyond 1e12"), "use smaller numbers"))
    }

    /// Refuses arguments that are left.
    pub(super) fn end(&mut self) -> Result<()> {
        match self.take() {
            None => Ok(()),
            Some(extra) => {
                let name = quoted(&self.name);
                let problem = format!("{name}: it has no argument here");
                Err(extra.place.wrong(problem, "remove what stands here, or name the request it belongs to"))
            }
        }
    }
}

/// A number that is whole, not negative and fits.
pub(super) fn whole(number: f64) -> Option<u32> {
    let is_whole = number >= 0.0 && number <= f64::from(u32::MAX) && number.fract() == 0.0;
    is_whole.then_some(number as u32)
}
