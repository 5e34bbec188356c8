//! Ctrl-C, SIGTERM and the end of a terminal: how a command ends before its time.
//!
//! A command ends by the very signal that it got, so that a shell sees 130 or 143 and its loops end
//! too. Most end at once, without leaving the files that were in the making; a training and a sweep
//! first come to a good end, and give up at the next signal. A process that a sweep started hears
//! of the sweep's end, whatever it ended by, at its standard input.

use crate::failure::Failure;
use hasard_sweep::STOPS_WITH_INPUT;
use std::io::Read;
use std::sync::Once;
use std::sync::atomic::{AtomicBool, AtomicI32, AtomicU8, Ordering};

const INTERRUPT: i32 = 2;
const TERMINATE: i32 = 15;

/// What a signal does.
#[derive(Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub enum Manner {
    /// No command runs: the caller of this library hears of signals by itself.
    Idle,
    /// The command ends there.
    AtOnce,
    /// The first raises [`STOP`], the second ends the command.
    Patient,
    /// The first raises [`STOP`], the second [`GIVE_UP`], the third ends the command.
    Parent,
}

/// Raised by the first signal of a patient command.
pub static STOP: AtomicBool = AtomicBool::new(false);
/// Raised by the second signal of a parent.
pub static GIVE_UP: AtomicBool = AtomicBool::new(false);

static MANNER: AtomicU8 = AtomicU8::new(Manner::Idle as u8);
/// The signal that asked for the end; 0 for none.
static SIGNAL: AtomicI32 = AtomicI32::new(0);

/// What signals do from here on.
pub fn behave(manner: Manner) {
    static LISTENING: Once = Once::new();
    LISTENING.call_once(listen);
    for flag in [&STOP, &GIVE_UP] {
        flag.store(false, Ordering::SeqCst);
    }
    SIGNAL.store(0, Ordering::SeqCst);
    MANNER.store(manner as u8, Ordering::SeqCst);
}

/// An error if a signal asked for the end, to be given once everything is in order.
pub fn check() -> Result<(), Failure> {
    match SIGNAL.load(Ordering::SeqCst) {
        0 => Ok(()),
        signal => Err(Failure::Interrupted(signal)),
    }
}

fn heard(signal: i32) {
    let manner = MANNER.load(Ordering::SeqCst);
    if manner == Manner::Idle as u8 {
        return;
    }
    if manner == Manner::AtOnce as u8 {
        end_by(signal);
    }
    let _ = SIGNAL.compare_exchange(0, signal, Ordering::SeqCst, Ordering::SeqCst);
    if !STOP.swap(true, Ordering::SeqCst) {
        match manner == Manner::Parent as u8 {
            true => note!("stopping the runs, each with a checkpoint; once more to give them up"),
            false => {
                note!("stopping after this rollout, with a checkpoint; once more to stop at once")
            }
        }
    } else if manner != Manner::Parent as u8 || GIVE_UP.swap(true, Ordering::SeqCst) {
        end_by(signal);
    }
}

/// Ends the process as the signal would have.
pub fn end_by(signal: i32) -> ! {
    hasard_media::files::remove_unfinished();
    #[cfg(unix)]
    let _ = signal_hook::low_level::emulate_default_handler(signal);
    std::process::exit(128 + signal)
}

fn listen() {
    if std::env::var_os(STOPS_WITH_INPUT).is_some() {
        let watch = std::thread::Builder::new().spawn(|| {
            let mut bytes = [0; 64];
            while std::io::stdin().read(&mut bytes).is_ok_and(|count| count > 0) {}
            // The terminal may have sent its signal to this process too: the two are one.
            if !STOP.load(Ordering::SeqCst) {
                heard(TERMINATE);
            }
        });
        // Without it the command ends as the system ends it.
        drop(watch);
    }
    #[cfg(unix)]
    {
        use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
        let mut signals = vec![SIGINT, SIGTERM];
        // `nohup` has it ignored: the run outlives its terminal.
        if !is_ignored(SIGHUP) {
            signals.push(SIGHUP);
        }
        // A file above `ulimit -f` is an error of the call then, as on a full disk, and no death.
        // SAFETY: ignoring a signal installs no handler that could run at a bad moment.
        unsafe { libc::signal(libc::SIGXFSZ, libc::SIG_IGN) };
        // Without it the system's own handling stays: the command ends, if less tidily.
        if let Ok(mut signals) = signal_hook::iterator::Signals::new(signals) {
            drop(std::thread::Builder::new().spawn(move || signals.forever().for_each(heard)));
        }
        debug_assert_eq!((SIGINT, SIGTERM), (INTERRUPT, TERMINATE));
    }
    #[cfg(not(unix))]
    let _ = ctrlc::set_handler(|| heard(INTERRUPT));
}

/// Whether the process that started this one had a signal ignored.
#[cfg(unix)]
fn is_ignored(signal: i32) -> bool {
    // SAFETY: `sigaction` is plain data for which zeros are valid, and with a null action the call
    // only fills it.
    unsafe {
        let mut now: libc::sigaction = std::mem::zeroed();
        libc::sigaction(signal, std::ptr::null(), &raw mut now) == 0
            && now.sa_sigaction == libc::SIG_IGN
    }
}
