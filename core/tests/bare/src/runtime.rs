//! What a program needs where there is neither std nor a C library: an entry, an exit, and the few
//! functions that compilers call without being asked. x86-64 Linux only.

use core::arch::{asm, naked_asm};
use core::ffi::c_int;
use core::panic::PanicInfo;

const EXIT_GROUP: u64 = 231;
const PANICKED: i32 = 101;

/// Where the kernel starts the program; functions expect the stack aligned to 16 bytes at the call.
#[unsafe(naked)]
#[unsafe(no_mangle)]
extern "C" fn _start() -> ! {
    naked_asm!("xor ebp, ebp", "and rsp, -16", "call {run}", "ud2", run = sym run)
}

extern "C" fn run() -> ! {
    exit(crate::main())
}

fn exit(code: i32) -> ! {
    // SAFETY: the system call ends the process and touches no memory of it.
    unsafe { asm!("syscall", in("rax") EXIT_GROUP, in("rdi") i64::from(code), options(noreturn, nostack)) }
}

#[panic_handler]
fn panicked(_: &PanicInfo<'_>) -> ! {
    exit(PANICKED)
}

/// Named by the tables of the precompiled `core`; never called, as panics end the program.
#[unsafe(no_mangle)]
extern "C" fn rust_eh_personality() {}

// Single instructions, since compilers turn loops that copy, fill or compare back into these very calls.

/// # Safety
/// As in C.
#[unsafe(no_mangle)]
unsafe extern "C" fn memcpy(to: *mut u8, from: *const u8, count: usize) -> *mut u8 {
    // SAFETY: the caller vouches for `count` bytes at both places; the direction flag is clear.
    unsafe { asm!("rep movsb", inout("rcx") count => _, inout("rdi") to => _, inout("rsi") from => _) }
    to
}

/// # Safety
/// As in C.
#[unsafe(no_mangle)]
unsafe extern "C" fn memmove(to: *mut u8, from: *const u8, count: usize) -> *mut u8 {
    if to.addr().wrapping_sub(from.addr()) >= count {
        // SAFETY: as the caller's; copying upwards never overwrites what is still to be read.
        return unsafe { memcpy(to, from, count) };
    }
    // SAFETY: as the caller's, from the last byte downwards; the direction flag is clear again afterwards.
    unsafe {
        asm!(
            "std",
            "rep movsb",
            "cld",
            inout("rcx") count => _,
            inout("rdi") to.wrapping_add(count).wrapping_sub(1) => _,
            inout("rsi") from.wrapping_add(count).wrapping_sub(1) => _,
        );
    }
    to
}

/// # Safety
/// As in C.
#[unsafe(no_mangle)]
unsafe extern "C" fn memset(to: *mut u8, value: c_int, count: usize) -> *mut u8 {
    // SAFETY: the caller vouches for `count` bytes; the direction flag is clear.
    unsafe { asm!("rep stosb", inout("rcx") count => _, inout("rdi") to => _, in("al") value as u8) }
    to
}

/// # Safety
/// As in C.
#[unsafe(no_mangle)]
unsafe extern "C" fn memcmp(left: *const u8, right: *const u8, count: usize) -> c_int {
    let (mut left_end, mut right_end) = (left, right);
    // SAFETY: the caller vouches for `count` bytes at both places; stops behind the first that differ.
    unsafe { asm!("repe cmpsb", inout("rcx") count => _, inout("rsi") left_end, inout("rdi") right_end) }
    if left_end == left {
        return 0;
    }
    // SAFETY: one byte was compared at least, so these two lie within the caller's ranges.
    unsafe { c_int::from(*left_end.sub(1)) - c_int::from(*right_end.sub(1)) }
}

/// # Safety
/// As in C.
#[unsafe(no_mangle)]
unsafe extern "C" fn bcmp(left: *const u8, right: *const u8, count: usize) -> c_int {
    // SAFETY: the same contract.
    unsafe { memcmp(left, right, count) }
}
