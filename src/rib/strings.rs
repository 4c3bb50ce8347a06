//! Strings of RIB: what their escapes stand for.

/// The text up to a quotation mark, and how many bytes it and the mark take; `None` if there is no mark.
pub(super) fn unescaped(bytes: &[u8]) -> Option<(String, usize)> {
    let mut text = Vec::new();
    let mut at = 0;
    loop {
        match *bytes.get(at)? {
            b'"' => return Some((String::from_utf8_lossy(&text).into_owned(), at + 1)),
            b'\\' => at += 1 + escape(&bytes[at + 1..], &mut text)?,
            byte => {
                text.push(byte);
                at += 1;
            }
        }
    }
}

/// Adds what an escape stands for, and gives the length of what follows its backslash.
fn escape(rest: &[u8], text: &mut Vec<u8>) -> Option<usize> {
    let byte = match *rest.first()? {
        b'0'..=b'7' => return Some(octal(rest, text)),
        // A line that goes on.
        b'\n' => return Some(1),
        b'n' => b'\n',
        b'r' => b'\r',
        b't' => b'\t',
        b'b' => 0x08,
        b'f' => 0x0c,
        other => other,
    };
    text.push(byte);
    Some(1)
}

/// Up to three octal digits; a byte has no room for more than eight bits.
fn octal(rest: &[u8], text: &mut Vec<u8>) -> usize {
    let digits = rest.iter().take(3).take_while(|byte| (b'0'..=b'7').contains(byte)).count();
    let value = rest[..digits].iter().fold(0_u32, |value, digit| value * 8 + u32::from(digit - b'0'));
    text.push((value & 0xff) as u8);
    digits
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escapes_are_undone() {
        let text = br#"a\"b\\c\n\t\101\60x\q\777" rest"#;
        let (read, length) = unescaped(text).expect("ends");
        assert_eq!(read, "a\"b\\c\n\tA0xq\u{fffd}");
        assert_eq!(&text[length..], b" rest");
        assert_eq!(unescaped(b"one\\\nline\"").map(|(text, _)| text).as_deref(), Some("oneline"));
    }

    #[test]
    fn strings_without_an_end_are_none() {
        for text in [&b"abc"[..], b"abc\\", b"abc\\\"", b""] {
            assert_eq!(unescaped(text), None);
        }
    }
}
