// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors and second-order tensors in three dimensions whose components are numbers or packs of numbers.
#pragma once

namespace drogue::fem {

template <class T>
struct Tensor {
  T component[3][3];

  T& operator()(int i, int j) { return component[i][j]; }
  const T& operator()(int i, int j) const { return component[i][j]; }
};

/// A tensor from a rule for its components.
template <class T, class Rule>
inline Tensor<T> tensor(const Rule& rule) {
  Tensor<T> t;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) t(i, j) = rule(i, j);
  }
  return t;
}

template <class T>
inline Tensor<T> operator+(const Tensor<T>& a, const Tensor<T>& b) {
  return tensor<T>([&](int i, int j) { return a(i, j) + b(i, j); });
}

template <class T>
inline Tensor<T>& operator+=(Tensor<T>& a, const Tensor<T>& b) {
  return a = a + b;
}

template <class T>
inline Tensor<T> operator-(const Tensor<T>& a, const Tensor<T>& b) {
  return tensor<T>([&](int i, int j) { return a(i, j) - b(i, j); });
}

template <class T>
inline Tensor<T> operator*(const T& s, const Tensor<T>& a) {
  return tensor<T>([&](int i, int j) { return s * a(i, j); });
}

/// a b
template <class T>
inline Tensor<T> operator*(const Tensor<T>& a, const Tensor<T>& b) {
  return tensor<T>([&](int i, int j) { return a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j); });
}

template <class T>
inline Tensor<T> transposed(const Tensor<T>& a) {
  return tensor<T>([&](int i, int j) { return a(j, i); });
}

template <class T>
struct Vector {
  T component[3];

  T& operator()(int i) { return component[i]; }
  const T& operator()(int i) const { return component[i]; }
};

template <class T>
inline Vector<T> operator+(const Vector<T>& a, const Vector<T>& b) {
  return {a(0) + b(0), a(1) + b(1), a(2) + b(2)};
}

template <class T>
inline Vector<T>& operator+=(Vector<T>& a, const Vector<T>& b) {
  return a = a + b;
}

template <class T>
inline Vector<T> operator-(const Vector<T>& a, const Vector<T>& b) {
  return {a(0) - b(0), a(1) - b(1), a(2) - b(2)};
}

template <class T>
inline Vector<T> operator*(const T& s, const Vector<T>& a) {
  return {s * a(0), s * a(1), s * a(2)};
}

/// a . b
template <class T>
inline T dot(const Vector<T>& a, const Vector<T>& b) {
  return a(0) * b(0) + a(1) * b(1) + a(2) * b(2);
}

/// a b^T
template <class T>
inline Tensor<T> outer(const Vector<T>& a, const Vector<T>& b) {
  return tensor<T>([&](int i, int j) { return a(i) * b(j); });
}

template <class T>
inline Vector<T> operator*(const Tensor<T>& a, const Vector<T>& b) {
  const auto row = [&](int i) { return a(i, 0) * b(0) + a(i, 1) * b(1) + a(i, 2) * b(2); };
  return {row(0), row(1), row(2)};
}

template <class T>
inline Vector<T> column(const Tensor<T>& a, int j) {
  return {a(0, j), a(1, j), a(2, j)};
}

template <class T>
inline Vector<T> row(const Tensor<T>& a, int i) {
  return {a(i, 0), a(i, 1), a(i, 2)};
}

/// a^T a, which is symmetric: six products.
template <class T>
inline Tensor<T> gram(const Tensor<T>& a) {
  Tensor<T> c;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      c(i, j) = a(0, i) * a(0, j) + a(1, i) * a(1, j) + a(2, i) * a(2, j);
      c(j, i) = c(i, j);
    }
  }
  return c;
}

/// a : b
template <class T>
inline T dot(const Tensor<T>& a, const Tensor<T>& b) {
  T sum = a(0, 0) * b(0, 0);
  for (int k = 1; k < 9; ++k) sum = sum + a(k / 3, k % 3) * b(k / 3, k % 3);
  return sum;
}

template <class T>
inline T trace(const Tensor<T>& a) {
  return a(0, 0) + a(1, 1) + a(2, 2);
}

/// det(a) a^{-T}
template <class T>
inline Tensor<T> cofactor(const Tensor<T>& a) {
  return tensor<T>([&](int i, int j) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
    return a(i1, j1) * a(i2, j2) - a(i1, j2) * a(i2, j1);
  });
}

template <class T>
inline T determinant(const Tensor<T>& a) {
  const Tensor<T> c = cofactor(a);
  return a(0, 0) * c(0, 0) + a(0, 1) * c(0, 1) + a(0, 2) * c(0, 2);
}

/// a^{-1}
template <class T>
inline Tensor<T> inverted(const Tensor<T>& a) {
  const Tensor<T> c = cofactor(a);
  const T scale = 1.0 / (a(0, 0) * c(0, 0) + a(0, 1) * c(0, 1) + a(0, 2) * c(0, 2));
  return tensor<T>([&](int i, int j) { return scale * c(j, i); });
}

}  // namespace drogue::fem
