//! Numbers as text in tables: rounded to so many digits, and then as short as they get.

use std::io::Write as _;

/// Appends `value`, rounded to `digits` significant digits, in the form described at
/// [`TableWriter`](super::TableWriter).
pub(super) fn push_number(text: &mut Vec<u8>, value: f64, digits: usize) {
    if value.is_nan() {
        return;
    }
    if value.is_infinite() {
        text.extend(if value > 0.0 { &b"inf"[..] } else { b"-inf" });
        return;
    }
    if value == 0.0 {
        text.push(b'0'); // never "-0"
        return;
    }
    let magnitude = value.abs();
    let is_plain = digits <= UNIQUE_DIGITS && (1e-5..0.9e15).contains(&magnitude);
    if is_plain && let Some((whole, exponent)) = rounded(magnitude, digits) {
        return plain(text, value < 0.0, whole, digits, exponent);
    }
    let shown = format!("{value:.*e}", digits.saturating_sub(1));
    if is_plain && let Some((whole, exponent)) = parts(&shown) {
        return plain(text, value < 0.0, whole, digits, exponent);
    }
    let rounded: f64 = shown.parse().unwrap_or(value);
    let magnitude = rounded.abs();
    let _ = if rounded == 0.0 {
        write!(text, "0")
    } else if (1e-5..1e15).contains(&magnitude) {
        write!(text, "{rounded}")
    } else {
        write!(text, "{rounded:e}")
    };
}

/// No two decimal numbers with so many significant digits are the same double, so that the shortest form of one is itself.
const UNIQUE_DIGITS: usize = 15;
/// Powers of ten that are doubles.
const POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16, 1e17, 1e18, 1e19, 1e20,
    1e21, 1e22,
];

/// A number from 1e-5 up to 1e15, rounded to `digits` significant digits: these as a whole number, and the exponent of the first. `None`
/// where one operation of round-off could decide which way it is rounded.
fn rounded(magnitude: f64, digits: usize) -> Option<(u64, i32)> {
    let (low, high) = (*POWERS.get(digits.checked_sub(1)?)?, *POWERS.get(digits)?);
    // The exponent from that of two, which is at most one too low.
    let two = (magnitude.to_bits() >> 52) as i32 - 1023;
    let mut exponent = (two * 1233) >> 12;
    let scaled = |exponent: i32| {
        let shift = digits as i32 - 1 - exponent;
        let power = *POWERS.get(shift.unsigned_abs() as usize)?;
        Some(if shift < 0 { magnitude / power } else { magnitude * power })
    };
    let mut value = scaled(exponent)?;
    if value >= high {
        exponent += 1;
        value = scaled(exponent)?;
    }
    if !(low..high).contains(&value) {
        return None;
    }
    let whole = value as u64;
    let over = value - whole as f64;
    if (over - 0.5).abs() <= 2.0 * f64::EPSILON * high {
        return None;
    }
    let whole = whole + u64::from(over > 0.5);
    Some(if whole as f64 >= high { (whole / 10, exponent + 1) } else { (whole, exponent) })
}

/// Digits and exponent of a text `d.ddde-x`.
fn parts(text: &str) -> Option<(u64, i32)> {
    let (mantissa, power) = text.trim_start_matches('-').split_once('e')?;
    let whole = mantissa.bytes().filter(u8::is_ascii_digit).fold(0, |sum, digit| 10 * sum + u64::from(digit - b'0'));
    Some((whole, power.parse().ok()?))
}

/// Appends a number in plain form without zeros at its end: its significant digits as a whole number with `count` of them, and the exponent
/// of the first.
fn plain(text: &mut Vec<u8>, negative: bool, mut whole: u64, count: usize, exponent: i32) {
    let mut digits = [b'0'; UNIQUE_DIGITS + 1];
    for pair in digits.chunks_exact_mut(2).rev().take(count.div_ceil(2)) {
        let two = (whole % 100) as u8;
        whole /= 100;
        (pair[0], pair[1]) = (b'0' + two / 10, b'0' + two % 10);
    }
    let digits = &digits[UNIQUE_DIGITS + 1 - count..];
    let last = digits[1..].iter().rposition(|digit| *digit != b'0').map_or(0, |k| k + 1);
    let digits = &digits[..=last];
    if negative {
        text.push(b'-');
    }
    let before = exponent + 1;
    if before <= 0 {
        text.extend_from_slice(&b"0.0000"[..2 + before.unsigned_abs() as usize]);
        text.extend_from_slice(digits);
    } else if let Some((integer, rest)) = digits.split_at_checked(before as usize).filter(|d| !d.1.is_empty()) {
        text.extend_from_slice(integer);
        text.push(b'.');
        text.extend_from_slice(rest);
    } else {
        text.extend_from_slice(digits);
        text.resize(text.len() + before as usize - digits.len(), b'0');
    }
}
