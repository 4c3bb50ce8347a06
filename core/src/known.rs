//! Known answers: asked of a device when it is opened. One that rounds, fuses or flushes otherwise is refused.

use crate::abi::{Frame, Question, Shared};
use crate::backend::Device;
use crate::kernel::known_answers::{OPERATIONS, answer};
use crate::stage::{Items, Stage};

/// Questions that are asked at once.
const BLOCK: usize = 1024;
/// Questions an operation.
const EACH: u32 = 2048;

/// An operation that a device computes otherwise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mismatch {
    /// What was asked.
    pub question: Question,
    /// The right answer, as bits.
    pub expected: u32,
    /// The device's answer, as bits.
    pub found: u32,
}

impl Mismatch {
    /// Name of the operation.
    #[must_use]
    pub fn operation(&self) -> &'static str {
        OPERATIONS[self.question.operation as usize % OPERATIONS.len()]
    }
}

/// Asks all questions; gives the first that is answered wrongly.
///
/// # Errors
/// What the device reports.
pub fn check<D: Device>(device: &mut D) -> Result<Option<Mismatch>, D::Error> {
    let frame = device.allocate("frame", Frame::LAYOUT, 1)?;
    let asked = device.allocate("questions", Question::LAYOUT, BLOCK as u64)?;
    let answered = device.allocate("answers", u32::LAYOUT, BLOCK as u64)?;
    device.write(&frame, &[Frame::default()])?;
    let total = OPERATIONS.len() as u32 * EACH;
    for first in (0..total).step_by(BLOCK) {
        let mut questions = [Question::default(); BLOCK];
        for (place, question) in questions.iter_mut().enumerate() {
            *question = self::question(first + place as u32);
        }
        device.write(&asked, &questions)?;
        device.dispatch(Stage::KnownAnswers, Items::Count(BLOCK as u32), &[&frame, &asked, &answered])?;
        let mut answers = [0; BLOCK];
        device.read(&answered, 0, &mut answers)?;
        for (question, found) in questions.into_iter().zip(answers) {
            let expected = answer(question);
            if found != expected {
                return Ok(Some(Mismatch { question, expected, found }));
            }
        }
    }
    Ok(None)
}

/// Question number `number`: operands of all magnitudes that its operation allows.
#[must_use]
pub fn question(number: u32) -> Question {
    let operation = number / EACH;
    let mut state = number;
    let (a, b, c) = (mixed(&mut state), mixed(&mut state), mixed(&mut state));
    match operation {
        // Denormals, now and then: a device must not flush them.
        0..=2 if number.is_multiple_of(8) => {
            Question { operation, a: a & 0x807f_ffff, b: float_bits(b, 100, 140), c: 0 }
        }
        0 | 1 | 3..=8 => Question {
            operation,
            a: float_bits(a, 115, 139),
            b: float_bits(b, 115, 139),
            c: float_bits(c, 115, 139),
        },
        2 => Question { operation, a: float_bits(a, 70, 180), b: float_bits(b, 70, 180), c: 0 },
        9 | 10 => Question { operation, a: float_bits(a, 10, 240) & 0x7fff_ffff, b: 0, c: 0 },
        11 => Question { operation, a: float_bits(a, 100, 147), b: 0, c: 0 },
        12 => Question { operation, a: float_bits(a, 100, 156), b: 0, c: 0 },
        13 => Question { operation, a: ((a as i32) >> 7) as u32, b: 0, c: 0 },
        14 => Question { operation, a: float_bits(a, 30, 250), b: 0, c: 0 },
        15 => Question { operation, a: float_bits(a, 0, 255), b: 0, c: 0 },
        _ => Question { operation, a, b, c: 0 },
    }
}

/// Random sign and mantissa with an exponent from `low` to below `high`.
const fn float_bits(bits: u32, low: u32, high: u32) -> u32 {
    let exponent = low + (bits >> 23 & 0xff) % (high - low);
    (bits & 0x807f_ffff) | exponent << 23
}

/// The next of a sequence of well mixed numbers (the finaliser of MurmurHash3, Appleby 2011).
const fn mixed(state: &mut u32) -> u32 {
    *state = state.wrapping_add(0x9e37_79b9);
    let mut z = *state;
    z = (z ^ (z >> 16)).wrapping_mul(0x85eb_ca6b);
    z = (z ^ (z >> 13)).wrapping_mul(0xc2b2_ae35);
    z ^ (z >> 16)
}
