//! Words as a shell takes them, for commands that are to be pasted.

use std::ffi::OsStr;

/// A word that POSIX shells, bash and zsh read as it is: unchanged where nothing in it is special,
/// in single quotes otherwise, and as `$'...'` where it holds control characters or bytes that are
/// no UTF-8.
#[must_use]
pub fn quote(word: impl AsRef<OsStr>) -> String {
    let word = word.as_ref();
    match word.to_str() {
        Some(text)
            if !text.is_empty()
                && text.chars().all(|c| c.is_ascii_alphanumeric() || "-_./=,+:@%".contains(c)) =>
        {
            text.to_owned()
        }
        Some(text) if !text.contains(char::is_control) => {
            format!("'{}'", text.replace('\'', "'\\''"))
        }
        _ => {
            let plain =
                |byte: u8| byte.is_ascii_graphic() && !b"'\\".contains(&byte) || byte == b' ';
            let letter = |byte: &u8| {
                if plain(*byte) { char::from(*byte).to_string() } else { format!("\\x{byte:02x}") }
            };
            // Each byte is written with two digits, so that no digit after it joins it.
            format!("$'{}'", word.as_encoded_bytes().iter().map(letter).collect::<String>())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn a_shell_reads_back_what_was_quoted() {
        use std::os::unix::ffi::{OsStrExt, OsStringExt};
        let words: [&[u8]; 9] = [
            b"runs/one",
            b"my runs/one",
            b"it's $HOME `x`",
            b"",
            b"-n",
            b"l\xe4ufe 7",
            b"a\nb\\x41'",
            "läufe".as_bytes(),
            b"~/*?[a]{b,c}!#&;|<>()\"",
        ];
        for word in words {
            let line = format!("printf %s {}", quote(OsStr::from_bytes(word)));
            let output = std::process::Command::new("bash").args(["-c", &line]).output().unwrap();
            assert_eq!(output.stdout, word, "{line}");
        }
        assert_eq!(quote("runs/a-b_c.d"), "runs/a-b_c.d");
        assert_eq!(quote(std::ffi::OsString::from_vec(b"\xff".to_vec())), "$'\\xff'");
    }
}
