#ifndef friction_tests_material_of_h
#define friction_tests_material_of_h

#include <common/parameters/material.h>

/** The material with these Lame constants. */
inline Friction::Material
material_of(const double lambda, const double mu)
{
  return Friction::Material(mu * (3. * lambda + 2. * mu) / (lambda + mu),
                            lambda / (2. * (lambda + mu)));
}

#endif
