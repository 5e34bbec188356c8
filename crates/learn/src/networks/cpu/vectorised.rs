//! Functions that are compiled once for each family of vector instructions.

/// Defines a function over slices whose plain loops are compiled for every family; the first
/// argument chooses among them.
macro_rules! vectorised {
    ($(#[$meta:meta])* $vis:vis fn $name:ident($($arg:ident: $ty:ty),* $(,)?) $body:block) => {
        $(#[$meta])*
        #[allow(clippy::too_many_arguments)]
        $vis fn $name(kernels: hasard_engine::simd::Simd, $($arg: $ty),*) {
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
                use hasard_engine::simd::Family;
                match kernels.family() {
                    // SAFETY: a `Simd` value proves that the processor has the instructions.
                    Family::Avx512 | Family::Avx512Bf16 | Family::AmxBf16 => return unsafe { avx512($($arg),*) },
                    // SAFETY: as for the wider family.
                    Family::Avx2 => return unsafe { avx2($($arg),*) },
                    Family::Plain => {}
                }
            }
            #[cfg(not(target_arch = "x86_64"))]
            let _ = kernels;
            body($($arg),*)
        }
    };
}
pub(crate) use vectorised;

/// Declares the files of a kernel for the families of vectors, where the processor's architecture
/// has them: `avx2` and `avx512` are those of x86-64, one for ARM would be `neon`.
macro_rules! kernel_files {
    ($($family:ident),+ $(,)?) => { $($crate::networks::cpu::vectorised::kernel_files!(@ $family);)+ };
    (@ neon) => {
        #[cfg(target_arch = "aarch64")]
        mod neon;
    };
    (@ $x86:ident) => {
        #[cfg(target_arch = "x86_64")]
        mod $x86;
    };
}
pub(crate) use kernel_files;
