//! Enums whose text is what users type.

/// An enum of names: its text is what users type, upper and lower case alike.
macro_rules! names {
    ($(#[$meta:meta])* $name:ident ($what:literal) { $($(#[$variant_meta:meta])* $variant:ident = $text:literal,)+ }) => {
        $(#[$meta])*
        #[derive(Clone, Copy, PartialEq, Eq, Debug, serde::Serialize, serde::Deserialize)]
        pub enum $name {
            $($(#[$variant_meta])* #[serde(rename = $text)] $variant,)+
        }

        impl $name {
            /// All of them.
            pub const ALL: &'static [$name] = &[$($name::$variant),+];

            /// The name in settings and messages.
            #[must_use]
            pub const fn name(self) -> &'static str {
                match self { $($name::$variant => $text,)+ }
            }
        }

        impl std::fmt::Display for $name {
            fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str(self.name())
            }
        }

        impl std::str::FromStr for $name {
            type Err = crate::error::LearnError;

            fn from_str(text: &str) -> Result<$name, crate::error::LearnError> {
                $name::ALL.iter().copied().find(|one| one.name().eq_ignore_ascii_case(text)).ok_or_else(|| {
                    let all: Vec<&str> = $name::ALL.iter().map(|one| one.name()).collect();
                    crate::error::LearnError::Config(format!("{} '{text}' is unknown; use one of {}", $what, all.join(", ")))
                })
            }
        }
    };
}

pub(super) use names;
