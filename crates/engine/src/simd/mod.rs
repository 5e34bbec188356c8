//! Which vector instructions are used. Every variant of an integer kernel gives the same bits; the
//! plain one reads like the formula.

#[cfg(all(target_arch = "x86_64", target_os = "linux"))]
mod amx;
#[cfg(target_arch = "x86_64")]
pub(crate) mod lookup;

use std::fmt;
use std::sync::OnceLock;

/// A family of vector instructions that this processor has: there is no other way to come by one.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Simd {
    family: Family,
    level: Level,
}

/// The families by their names, from narrow to wide: what arithmetic with floating-point numbers is
/// compiled for.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Family {
    /// Whatever the compiler makes of plain code. It rounds every product and every sum.
    Plain,
    /// Vectors of 32 bytes, and sums of products that are rounded once (Haswell and Zen onward).
    Avx2,
    /// Vectors of 64 bytes with masks (Skylake's servers and Zen 4 onward): the same bits as those
    /// of [`Family::Avx2`].
    Avx512,
    /// The same, but that a learner's matrices are multiplied as bfloat16 and summed as 32-bit
    /// numbers (Cooper Lake and Zen 4 onward).
    Avx512Bf16,
    /// The same by a unit that multiplies whole tiles of matrices (AMX; Sapphire Rapids onward). It
    /// adds up in another order.
    AmxBf16,
}

impl Family {
    /// It multiplies a learner's matrices as bfloat16.
    #[inline(always)]
    #[must_use]
    pub const fn rounds(self) -> bool {
        matches!(self, Family::Avx512Bf16 | Family::AmxBf16)
    }
}

/// What integer kernels are compiled for, from narrow to wide. All give the same bits.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(crate) enum Level {
    /// Plain code.
    Plain,
    /// Vectors of 16 bytes, which every 64-bit ARM has. Arithmetic with floating-point numbers is
    /// plain beside it.
    Neon,
    /// Vectors of 32 bytes.
    Avx2,
    /// Vectors of 64 bytes with masks, and look-ups of 64 bytes at once (Ice Lake and Zen 4
    /// onward).
    Avx512,
}

/// The variable that forces a family.
const VARIABLE: &str = "HASARD_SIMD";

impl Simd {
    /// What every processor has.
    pub const PLAIN: Simd = Simd { family: Family::Plain, level: Level::Plain };

    /// Every family of this processor that computes with 32-bit numbers, the widest last.
    #[must_use]
    pub fn available() -> Vec<Simd> {
        let mut all = vec![Simd::PLAIN];
        if cfg!(target_arch = "aarch64") {
            all.push(Simd { family: Family::Plain, level: Level::Neon });
        }
        #[cfg(target_arch = "x86_64")]
        {
            if is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma") {
                all.push(Simd { family: Family::Avx2, level: Level::Avx2 });
            }
            let wide = is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512bw")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512vl");
            if wide && all.len() == 2 {
                let level = if is_x86_feature_detected!("avx512vbmi") {
                    Level::Avx512
                } else {
                    Level::Avx2
                };
                all.push(Simd { family: Family::Avx512, level });
            }
        }
        all
    }

    /// The families of this processor with products in bfloat16, the fastest last. Nothing chooses
    /// them but their names, and a run's settings.
    #[must_use]
    pub fn bfloat16() -> Vec<Simd> {
        #[cfg_attr(not(target_arch = "x86_64"), allow(unused_mut, reason = "x86-64 adds to it"))]
        let mut all = Vec::new();
        #[cfg(target_arch = "x86_64")]
        {
            let widest = Simd::widest();
            if widest.family == Family::Avx512 && is_x86_feature_detected!("avx512bf16") {
                all.push(Simd { family: Family::Avx512Bf16, ..widest });
                #[cfg(target_os = "linux")]
                if amx::is_permitted() {
                    all.push(Simd { family: Family::AmxBf16, ..widest });
                }
            }
        }
        all
    }

    /// All that this processor has: [`Simd::available`], then [`Simd::bfloat16`].
    #[must_use]
    pub fn all() -> Vec<Simd> {
        Simd::available().into_iter().chain(Simd::bfloat16()).collect()
    }

    /// The widest family of this processor that computes with 32-bit numbers, or the one that the
    /// variable `HASARD_SIMD` names.
    ///
    /// # Errors
    /// When the variable names none, or one that this processor lacks.
    pub fn chosen() -> Result<Simd, SimdError> {
        Ok(Simd::forced()?.unwrap_or(Simd::widest()))
    }

    /// The family that the variable `HASARD_SIMD` names, if it is there.
    ///
    /// # Errors
    /// When it names none, or one that this processor lacks.
    pub fn forced() -> Result<Option<Simd>, SimdError> {
        static FORCED: OnceLock<Result<Option<Simd>, SimdError>> = OnceLock::new();
        let read = || {
            std::env::var_os(VARIABLE).map(|name| Simd::named(&name.to_string_lossy())).transpose()
        };
        FORCED.get_or_init(read).clone()
    }

    /// The widest family of this processor that computes with 32-bit numbers.
    #[must_use]
    pub fn widest() -> Simd {
        Simd::available().pop().unwrap_or(Simd::PLAIN)
    }

    /// The family of a name: `plain` (or `portable`), `neon`, `avx2`, `avx512`,
    /// `avx512bf16` or `amxbf16`.
    fn named(name: &str) -> Result<Simd, SimdError> {
        let known = if name == "portable" { "plain" } else { name };
        let there = Simd::all().into_iter().find(|simd| simd.name() == known);
        there.ok_or_else(|| SimdError { given: name.escape_default().take(40).collect() })
    }

    /// The name by which `HASARD_SIMD` chooses it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self.family {
            Family::Plain if matches!(self.level, Level::Neon) => "neon",
            Family::Plain => "plain",
            Family::Avx2 => "avx2",
            Family::Avx512 => "avx512",
            Family::Avx512Bf16 => "avx512bf16",
            Family::AmxBf16 => "amxbf16",
        }
    }

    /// What arithmetic with floating-point numbers may use.
    #[inline(always)]
    #[must_use]
    pub const fn family(self) -> Family {
        self.family
    }

    /// What integer kernels may use.
    #[inline(always)]
    pub(crate) const fn level(self) -> Level {
        self.level
    }
}

impl fmt::Display for Simd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(self.name())
    }
}

/// Declares the files of a kernel, one for each family of vectors, where the processor's
/// architecture has it. These two macros hold every `cfg` that a kernel needs. `neon` is a file for
/// ARM; every other name is one for x86-64, mostly `avx2` and `avx512`.
macro_rules! kernel_files {
    ($($family:ident),+ $(,)?) => { $($crate::simd::kernel_files!(@ $family);)+ };
    (@ neon) => {
        #[cfg(target_arch = "aarch64")]
        pub mod neon;
    };
    (@ $x86:ident) => {
        #[cfg(target_arch = "x86_64")]
        pub mod $x86;
    };
}
pub(crate) use kernel_files;

/// Calls the widest variant of a kernel that a [`Simd`] allows and whose condition holds, else the
/// scalar one: the families stand from wide to narrow. A variant is an `unsafe` call as its
/// instructions must be there; the `Simd` proves that they are.
macro_rules! dispatch {
    ($simd:expr; $(avx512 $(if $fits_avx512:expr)? => $avx512:expr,)? $(avx2 $(if $fits_avx2:expr)? => $avx2:expr,)?
     $(neon $(if $fits_neon:expr)? => $neon:expr,)? scalar => $scalar:expr $(,)?) => {'dispatched: {
        #[cfg(target_arch = "x86_64")]
        match $simd.level() {
            // SAFETY: a `Simd` value proves that the processor has the instructions.
            $($crate::simd::Level::Avx512 $(if $fits_avx512)? => break 'dispatched unsafe { $avx512 },)?
            // SAFETY: as for the wider family.
            $($crate::simd::Level::Avx2 $(if $fits_avx2)? => break 'dispatched unsafe { $avx2 },)?
            _ => {}
        }
        $(#[cfg(target_arch = "aarch64")]
        if $simd.level() == $crate::simd::Level::Neon $(&& $fits_neon)? {
            // SAFETY: a `Simd` value proves that the processor has the instructions.
            break 'dispatched unsafe { $neon };
        })?
        #[cfg(not(target_arch = "x86_64"))]
        let _ = $simd;
        $scalar
    }};
}
pub(crate) use dispatch;

/// Bytes that come to a cache together, mostly.
const LINE: usize = 64;

/// Asks for a value to be brought into the nearest cache: a hint without effect on any result.
#[inline(always)]
pub(crate) fn prefetch<T: ?Sized>(value: &T) {
    prefetch_lines(std::ptr::from_ref(value).cast::<u8>(), size_of_val(value).div_ceil(LINE));
}

/// Asks for some cache lines from an address on, which need not be that of anything.
#[inline(always)]
pub(crate) fn prefetch_lines(start: *const u8, lines: usize) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        for line in 0..lines {
            // SAFETY: every x86-64 has the instruction, and it may be given any address.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(start.cast::<i8>().wrapping_add(LINE * line)) }
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = (start, lines);
}

/// `HASARD_SIMD` names no family of this processor.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct SimdError {
    /// What was asked for.
    pub given: String,
}

impl SimdError {
    /// What may be asked for.
    #[must_use]
    pub fn allowed() -> String {
        let names: Vec<&str> = Simd::all().into_iter().map(Simd::name).collect();
        format!("one of {} on this processor", names.join(", "))
    }
}

impl fmt::Display for SimdError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{VARIABLE} is {}, but must be {}, or left out", self.given, SimdError::allowed())
    }
}

impl std::error::Error for SimdError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn families_are_named_and_unknown_ones_refused() {
        for simd in Simd::all() {
            assert_eq!(Simd::named(simd.name()), Ok(simd));
        }
        assert_eq!(Simd::named("portable"), Ok(Simd::PLAIN));
        assert!(
            Simd::available().iter().all(|simd| !simd.family().rounds()),
            "nothing but their names chooses them"
        );
        for name in ["", "AVX2", "sse9", "avx512\n"] {
            assert!(Simd::named(name).unwrap_err().to_string().contains("must be one of plain"));
        }
    }
}
