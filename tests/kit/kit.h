// The kit that all test programs share: one include for checks, random numbers, contexts, maps,
// files and scenes. context.h adds a context for a whole program, quadrature.h the integrals of
// reflection models.
#ifndef KILN_KIT_H
#define KILN_KIT_H

#include "check.h"
#include "engines.h"
#include "failing.h"
#include "folder.h"
#include "maps.h"
#include "random.h"
#include "reference.h"
#include "scene.h"
#include "stopping.h"

#endif
