//! The words of the text lumps `TEXTURES`, `ANIMDEFS` and `MAPINFO`.

/// Most words of a lump; the largest published ones have some thousand.
const LIMIT: usize = 1 << 18;

/// Splits a text into words: quoted strings without their quotes, `{`, `}`, `,`, `=` and `;` by
/// themselves; comments are left out.
pub(super) fn words(bytes: &[u8]) -> Vec<&str> {
    let mut words = Vec::new();
    let mut rest = bytes;
    while let Some(&byte) = rest.first()
        && words.len() < LIMIT
    {
        let length = match byte {
            _ if byte.is_ascii_whitespace() || !byte.is_ascii() || byte.is_ascii_control() => {
                rest = &rest[1..];
                continue;
            }
            b'/' if rest.starts_with(b"//") => {
                rest = &rest[until(rest, b"\n")..];
                continue;
            }
            b'/' if rest.starts_with(b"/*") => {
                rest = &rest[(until(rest, b"*/") + 2).min(rest.len())..];
                continue;
            }
            b'"' => {
                let end = until(&rest[1..], b"\"") + 1;
                words.push(std::str::from_utf8(&rest[1..end]).unwrap_or(""));
                rest = &rest[(end + 1).min(rest.len())..];
                continue;
            }
            b'{' | b'}' | b',' | b'=' | b';' => 1,
            _ => rest
                .iter()
                .position(|byte| !byte.is_ascii_graphic() || b"{},=;\"".contains(byte))
                .unwrap_or(rest.len()),
        };
        words.push(std::str::from_utf8(&rest[..length]).unwrap_or(""));
        rest = &rest[length..];
    }
    words
}

/// Where `end` begins, or the length.
fn until(bytes: &[u8], end: &[u8]) -> usize {
    bytes.windows(end.len()).position(|window| window == end).unwrap_or(bytes.len())
}

#[cfg(test)]
mod tests {
    use super::words;

    #[test]
    fn texts_fall_into_words() {
        let text = b"Texture \"A B\",64, 128 // comment {\n{ Patch x,-1 /* more\n */ } =;\"open";
        let expected = [
            "Texture", "A B", ",", "64", ",", "128", "{", "Patch", "x", ",", "-1", "}", "=", ";",
            "open",
        ];
        assert_eq!(words(text), expected);
        for text in [&b"/*"[..], b"/", b"\"", b"\xff\x00", b"//", b"a\xffb"] {
            words(text);
        }
    }
}
