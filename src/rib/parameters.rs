//! Parameter lists: names with values, and what is declared about the names (RenderMan Interface 3.2, section 3).

use std::collections::HashMap;

use super::place::{Place, quoted};
use super::request::{MAX_NUMBER, Request, Value};
use crate::error::{Error, Result};

/// How many values a parameter has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Class {
    /// One.
    Constant,
    /// One a face, patch or curve.
    Uniform,
    /// One a corner of these.
    Varying,
    /// One a control point.
    Vertex,
    /// One a corner of each face.
    FaceVarying,
}

/// What is known about a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Declaration {
    pub(super) class: Class,
    /// Numbers that make up a value.
    pub(super) width: usize,
}

impl Declaration {
    /// From words such as `uniform float[2]`; what is left out is uniform, and one number.
    fn of(words: &str) -> Option<Self> {
        let mut found = Self { class: Class::Uniform, width: 1 };
        for word in words.split_whitespace() {
            let (word, length) = match word.split_once('[') {
                None => (word, 1),
                Some((word, length)) => (word, length.strip_suffix(']')?.trim().parse().ok()?),
            };
            match (class_of(word), width_of(word)) {
                (Some(class), _) => found.class = class,
                (_, Some(width)) => found.width = usize::checked_mul(width, length)?,
                (None, None) if word.is_empty() => found.width = length,
                (None, None) => return None,
            }
        }
        Some(found)
    }

    /// Of names that need no declaration; others are uniform.
    fn standard(name: &str) -> Self {
        let (class, width) = match name {
            "P" => (Class::Vertex, 3),
            "Pw" => (Class::Vertex, 4),
            "N" | "Cs" | "Os" => (Class::Varying, 3),
            "st" => (Class::Varying, 2),
            "s" | "t" | "width" => (Class::Varying, 1),
            "constantwidth" => (Class::Constant, 1),
            _ => (Class::Uniform, 1),
        };
        Self { class, width }
    }
}

fn class_of(word: &str) -> Option<Class> {
    Some(match word {
        "constant" => Class::Constant,
        "uniform" => Class::Uniform,
        "varying" => Class::Varying,
        "vertex" => Class::Vertex,
        "facevarying" | "facevertex" => Class::FaceVarying,
        _ => return None,
    })
}

fn width_of(word: &str) -> Option<usize> {
    Some(match word {
        "float" | "int" | "integer" | "string" | "bool" => 1,
        "color" | "point" | "vector" | "normal" => 3,
        "hpoint" => 4,
        "mpoint" | "matrix" => 16,
        _ => return None,
    })
}

/// What names are declared to be.
#[derive(Debug, Default)]
pub(super) struct Declarations {
    known: HashMap<String, Declaration>,
}

impl Declarations {
    /// `Declare "name" "declaration"`.
    pub(super) fn declare(&mut self, request: &mut Request) -> Result<()> {
        let name = request.text("name")?;
        let words = request.text("declaration")?;
        let declaration = Declaration::of(&words).ok_or_else(|| undeclared(&request.place, &words))?;
        self.known.insert(name, declaration);
        Ok(())
    }

    /// The name and the declaration in one string.
    fn inline(&self, text: &str, place: &Place) -> Result<(String, Declaration)> {
        let text = text.trim();
        match text.rsplit_once(|letter: char| letter.is_whitespace() || letter == ']') {
            None => {
                let known = self.known.get(text).copied();
                Ok((text.to_owned(), known.unwrap_or_else(|| Declaration::standard(text))))
            }
            Some((_, name)) => {
                let words = &text[..text.len() - name.len()];
                let declaration = Declaration::of(words).ok_or_else(|| undeclared(place, text))?;
                Ok((name.to_owned(), declaration))
            }
        }
    }
}

fn undeclared(place: &Place, words: &str) -> Error {
    let problem = format!("{} does not declare a parameter", quoted(words));
    place.wrong(problem, "write a class, a type and a name, for example \"vertex point P\"")
}

/// A name with its values.
#[derive(Debug)]
pub(super) struct Parameter {
    pub(super) name: String,
    pub(super) declaration: Declaration,
    pub(super) value: Value,
    pub(super) place: Place,
}

impl Parameter {
    /// Its numbers, of which none is beyond what can be drawn.
    pub(super) fn numbers(self) -> Result<Vec<f64>> {
        let Self { name, value, place, .. } = self;
        let Some(numbers) = value.numbers() else {
            let problem = format!("the value of {} is not numbers", quoted(&name));
            return Err(place.wrong(problem, "write numbers without quotation marks"));
        };
        if numbers.iter().all(|number| number.abs() <= MAX_NUMBER) {
            return Ok(numbers);
        }
        Err(place.wrong(format!("a number of {} is beyond 1e12", quoted(&name)), "use smaller numbers"))
    }

    /// Its `N` numbers.
    fn list<const N: usize>(self) -> Result<[f64; N]> {
        let (name, place) = (quoted(&self.name), self.place.clone());
        let numbers = self.numbers()?;
        let count = numbers.len();
        let wrong = |_| place.wrong(format!("{name} has {count} numbers"), format!("give it {N}"));
        numbers.try_into().map_err(wrong)
    }

    /// Its values, of so many numbers each.
    pub(super) fn values<const N: usize>(self) -> Result<Vec<[f64; N]>> {
        let (name, place) = (quoted(&self.name), self.place.clone());
        let numbers = self.numbers()?;
        let (values, rest) = numbers.as_chunks::<N>();
        if rest.is_empty() {
            return Ok(values.to_vec());
        }
        let problem = format!("{name} has {} numbers", numbers.len());
        Err(place.wrong(problem, format!("give it {N} for each value")))
    }
}

/// A parameter list. Its parameters are there until they are taken.
#[derive(Debug, Default)]
pub(super) struct Parameters {
    list: Vec<Parameter>,
}

impl Parameters {
    /// What is left of the request's arguments.
    pub(super) fn of(request: &mut Request, declarations: &Declarations) -> Result<Self> {
        let mut list = Vec::new();
        while request.has_more() {
            let text = request.text("parameter's name")?;
            let (name, declaration) = declarations.inline(&text, &request.place)?;
            let Some(argument) = request.take() else {
                let problem = format_args!("the value of {} is missing", quoted(&name));
                return Err(request.wrong(problem, "is the file cut short?"));
            };
            list.push(Parameter { name, declaration, value: argument.value, place: argument.place });
        }
        Ok(Self { list })
    }

    /// The parameter of this name, if it is there. Of several the last one counts.
    pub(super) fn take(&mut self, name: &str) -> Option<Parameter> {
        let found = self.list.iter().rposition(|parameter| parameter.name == name)?;
        let parameter = self.list.swap_remove(found);
        self.list.retain(|other| other.name != name);
        Some(parameter)
    }

    /// The `N` numbers of a parameter, if it is there.
    pub(super) fn list<const N: usize>(&mut self, name: &str) -> Result<Option<[f64; N]>> {
        self.take(name).map(Parameter::list).transpose()
    }

    /// The number of a parameter, if it is there.
    pub(super) fn number(&mut self, name: &str) -> Result<Option<f64>> {
        Ok(self.list::<1>(name)?.map(|[number]| number))
    }

    /// Those that nobody has taken, in no particular order.
    pub(super) fn rest(self) -> impl Iterator<Item = Parameter> {
        self.list.into_iter()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn inline(text: &str) -> Option<(String, Declaration)> {
        let place = Place { path: std::path::Path::new("x.rib").into(), line: 1 };
        Declarations::default().inline(text, &place).ok()
    }

    #[test]
    fn declarations_stand_in_the_name_or_are_standard() {
        for (text, name, class, width) in [
            ("P", "P", Class::Vertex, 3),
            ("vertex point P", "P", Class::Vertex, 3),
            (" vertex  hpoint Pw ", "Pw", Class::Vertex, 4),
            ("uniform float width", "width", Class::Uniform, 1),
            ("facevarying float[2] st", "st", Class::FaceVarying, 2),
            ("facevarying float [2] st", "st", Class::FaceVarying, 2),
            ("vertex float[2]st", "st", Class::Vertex, 2),
            ("float Ks", "Ks", Class::Uniform, 1),
            ("constant color Cs", "Cs", Class::Constant, 3),
            ("Kd", "Kd", Class::Uniform, 1),
        ] {
            let expected = (name.to_owned(), Declaration { class, width });
            assert_eq!(inline(text), Some(expected), "{text}");
        }
    }

    #[test]
    fn what_is_no_declaration_is_refused() {
        for text in ["wavy float x", "float[ x", "float[-1] x", "float[99999999999999999999] x", "a b"] {
            assert_eq!(inline(text), None, "{text}");
        }
    }
}
