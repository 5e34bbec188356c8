//! Whether this process may use the unit for tiles of matrices: Linux gives its 8 KB of registers to
//! those that ask.

use std::arch::x86_64::__cpuid_count;
use std::sync::OnceLock;

/// Asks for the registers of a unit (arch_prctl's ARCH_REQ_XCOMP_PERM).
const ASK: libc::c_int = 0x1023;
/// Data of tiles, among the states of a processor.
const TILE_DATA: libc::c_int = 18;

/// The processor has the unit, with products of bfloat16, and the system gave it to this process.
pub(super) fn is_permitted() -> bool {
    static PERMITTED: OnceLock<bool> = OnceLock::new();
    *PERMITTED.get_or_init(|| {
        let features = __cpuid_count(7, 0).edx;
        let (products, tiles) = (features >> 22 & 1, features >> 24 & 1);
        // SAFETY: the call takes two numbers and touches no memory of this process.
        products & tiles == 1 && unsafe { libc::syscall(libc::SYS_arch_prctl, ASK, TILE_DATA) } == 0
    })
}
