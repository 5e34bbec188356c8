//! Which vector instructions the kernels use, and functions compiled once for each.

use std::fmt;
use std::sync::OnceLock;

use crate::error::LearnError;

/// A family of kernels that this processor can run: there is no other way to come by one.
///
/// All families sum in the same order. The two with vector instructions fuse multiplication and addition, so that they give
/// the same bits as each other; the portable one rounds in between, as plain code does on every machine.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Kernels(Level);

/// Vector instructions.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Level {
    /// 512-bit registers with fused multiply-add.
    Avx512,
    /// 256-bit registers with fused multiply-add.
    Avx2,
    /// Whatever the compiler makes of plain loops.
    Portable,
}

/// The variable that forces a family, for the engine's kernels and these alike.
const VARIABLE: &str = "HASARD_SIMD";

impl Kernels {
    /// Those that every processor has, with the same bits on each.
    pub const PORTABLE: Kernels = Kernels(Level::Portable);

    /// The families that this processor has, the fastest first.
    #[must_use]
    pub fn available() -> Vec<Kernels> {
        let mut all = Vec::new();
        #[cfg(target_arch = "x86_64")]
        {
            let wide = is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512bw")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512vl");
            if wide {
                all.push(Kernels(Level::Avx512));
            }
            if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
                all.push(Kernels(Level::Avx2));
            }
        }
        all.push(Kernels::PORTABLE);
        all
    }

    /// The fastest family of this processor, or the one that `HASARD_SIMD` names.
    ///
    /// # Errors
    /// When the variable names none, or one that this processor lacks.
    pub fn chosen() -> Result<Kernels, LearnError> {
        static CHOSEN: OnceLock<Result<Kernels, String>> = OnceLock::new();
        let choose = || match std::env::var(VARIABLE) {
            Err(_) => Ok(Kernels::available()[0]),
            Ok(name) => Kernels::named(&name).map_err(|error| format!("{VARIABLE}={name}: {error}")),
        };
        CHOSEN.get_or_init(choose).clone().map_err(LearnError::Config)
    }

    /// The family of a name: `plain` (or `portable`), `avx2`, `avx512`.
    fn named(name: &str) -> Result<Kernels, String> {
        let name = if name == "plain" { "portable" } else { name };
        if !["portable", "avx2", "avx512"].contains(&name) {
            return Err("unknown; use one of plain, avx2, avx512".into());
        }
        let there = Kernels::available().into_iter().find(|kernels| kernels.name() == name);
        there.ok_or_else(|| format!("this processor has no {name}; leave the variable out, or use plain"))
    }

    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self.0 {
            Level::Avx512 => "avx512",
            Level::Avx2 => "avx2",
            Level::Portable => "portable",
        }
    }

    pub(crate) const fn level(self) -> Level {
        self.0
    }
}

impl fmt::Display for Kernels {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Defines a function over slices whose plain loops are compiled for every family; the first argument chooses among them.
macro_rules! vectorised {
    ($(#[$meta:meta])* $vis:vis fn $name:ident($($arg:ident: $ty:ty),* $(,)?) $body:block) => {
        $(#[$meta])*
        #[allow(clippy::too_many_arguments)]
        $vis fn $name(kernels: $crate::networks::cpu::simd::Kernels, $($arg: $ty),*) {
            #[inline(always)]
            #[allow(clippy::too_many_arguments)]
            fn body($($arg: $ty),*) $body
            #[cfg(target_arch = "x86_64")]
            {
                #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl")]
                #[allow(clippy::too_many_arguments)]
                fn avx512($($arg: $ty),*) {
                    body($($arg),*)
                }
                #[target_feature(enable = "avx2,fma")]
                #[allow(clippy::too_many_arguments)]
                fn avx2($($arg: $ty),*) {
                    body($($arg),*)
                }
                match kernels.level() {
                    // SAFETY: whoever has these kernels has these instructions.
                    $crate::networks::cpu::simd::Level::Avx512 => return unsafe { avx512($($arg),*) },
                    // SAFETY: as above.
                    $crate::networks::cpu::simd::Level::Avx2 => return unsafe { avx2($($arg),*) },
                    $crate::networks::cpu::simd::Level::Portable => {}
                }
            }
            #[cfg(not(target_arch = "x86_64"))]
            let _ = kernels;
            body($($arg),*)
        }
    };
}
pub(crate) use vectorised;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kernels_are_named_and_unknown_ones_refused() {
        assert_eq!(Kernels::named("plain"), Ok(Kernels::PORTABLE));
        for kernels in Kernels::available() {
            assert_eq!(Kernels::named(kernels.name()), Ok(kernels));
        }
        assert!(Kernels::named("sse9").unwrap_err().contains("plain, avx2, avx512"));
    }
}
