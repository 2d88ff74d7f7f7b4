#ifndef friction_scene_materials_h
#define friction_scene_materials_h

#include <common/parameters/material.h>

#include <deal.II/base/function.h>
#include <deal.II/base/point.h>
#include <deal.II/base/types.h>

#include <memory>
#include <vector>

namespace Friction
{
  using namespace dealii;

  /**
   * What a body is made of: one material, or others in some of its regions. A
   * region is what cells of a mesh file have as their physical id, or where the
   * middle of a cell fulfils a condition. Its border therefore always consists
   * of faces of the mesh, and one that is given by a condition becomes the
   * finer the finer the mesh is.
   *
   * Within a cell the material is constant. Nothing is looked up as long as
   * there are no regions.
   */
  template <int dim>
  class Materials
  {
  public:
    /** One material everywhere. Implicit: a material is what most bodies are
     * made of. */
    Materials(const Material &everywhere);

    /** Cells with this physical id have another material. */
    void add_region(const types::material_id id, const Material &material);

    /** Cells in whose middle the function is not zero have another material.
     * @param condition  of one component, which may throw InputError. */
    void add_region(const std::shared_ptr<const Function<dim>> &condition,
                    const Material                             &material);

    bool
    is_homogeneous() const
    {
      return regions.empty();
    }

    /** The number of a cell's region, for an iterator to any kind of cell; zero
     * if it is in none. In the last that it is in, if there are several. */
    template <typename CellIterator>
    unsigned int
    region(const CellIterator &cell) const
    {
      return is_homogeneous()
        ? 0
        : find_region(cell->material_id(), cell->center());
    }

    /** The material of a cell. */
    template <typename CellIterator>
    const Material &
    of(const CellIterator &cell) const
    {
      return all[region(cell)];
    }

    /** By number of the region; the first is that of what is in none. */
    const std::vector<Material> &
    of_regions() const
    {
      return all;
    }

    /** The material of what is in no region. */
    const Material &
    base() const
    {
      return all[0];
    }

    /** The physical ids of the regions that have one, in their order. */
    std::vector<types::material_id> ids() const;

    /** Whether any of them has the mean over each cell as volumetric strain. */
    bool uses_means() const;

  private:
    // One of the two.
    struct Region
    {
      types::material_id                   id;
      std::shared_ptr<const Function<dim>> condition;
    };

    std::vector<Material> all;
    std::vector<Region>   regions;

    unsigned int find_region(const types::material_id id,
                             const Point<dim>        &middle) const;
  };
} // namespace Friction

#endif
